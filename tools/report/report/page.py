"""Writes the report: one HTML file that holds its pictures, or a folder of PNG files with an index.html."""
import base64
import html
import io
import os

import matplotlib.pyplot as plt

from .errors import ReportError

CSS = """body{font:15px/1.5 system-ui,sans-serif;color:#222;max-width:1160px;margin:1.5em auto;padding:0 1em}
h1{font-size:1.5em}h2{font-size:1.2em;margin-top:2em;border-bottom:1px solid #ddd}figure{margin:1.2em 0}img{max-width:100%;height:auto}
figcaption{color:#555;max-width:60em}table{border-collapse:collapse;margin:1em 0;font-size:.92em}
td,th{border-bottom:1px solid #ddd;padding:.2em .9em .2em 0;text-align:left;vertical-align:top}th{font-weight:600}
.missing{background:#fff6e0;border-left:4px solid #e69f00;padding:.4em 1em}"""

TRIMMED = {"bbox_inches": "tight", "pad_inches": 0.12}  # what a picture leaves empty at its edges


class Page:
    """Collects pictures and tables in their order, and writes them when all are there."""

    def __init__(self, out, title):
        """`out` is an HTML file where it ends so, else a folder."""
        self.out, self.title, self.body, self.written = out, title, [], []
        self.is_file = out.lower().endswith((".html", ".htm"))
        try:
            os.makedirs(os.path.dirname(os.path.abspath(out)) if self.is_file else out, exist_ok=True)
        except OSError as error:
            raise ReportError(f"{out}: {error.strerror}; give another --out") from error

    def heading(self, text):
        self.body.append(f"<h2>{html.escape(text)}</h2>")

    def missing(self, sentences):
        """What the report does not show, and why."""
        if sentences:
            items = "".join(f"<li>{html.escape(one)}</li>" for one in sentences)
            self.body.append(f'<div class="missing"><p>What is not shown:</p><ul>{items}</ul></div>')

    def table(self, header, rows, caption=""):
        if not rows:
            return
        cells = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>\n" for row in rows)
        head = "".join(f"<th>{html.escape(cell)}</th>" for cell in header)
        title = f"<caption>{html.escape(caption)}</caption>" if caption else ""
        self.body.append(f"<table>{title}<tr>{head}</tr>\n{cells}</table>")

    def picture(self, figure, name, caption):
        """Adds a figure, and closes it; None is nothing to show."""
        if figure is None:
            return
        try:
            if self.is_file:
                buffer = io.BytesIO()
                figure.savefig(buffer, format="png", **TRIMMED)
                source = "data:image/png;base64," + base64.b64encode(buffer.getvalue()).decode()
            else:
                source = name
                self._write(os.path.join(self.out, name), lambda path: figure.savefig(path, **TRIMMED))
        finally:
            plt.close(figure)
        text = html.escape(caption)
        self.body.append(f'<figure><img src="{source}" alt="{html.escape(name[:-4])}: {text}"><figcaption>{text}</figcaption></figure>')

    def finish(self):
        """Writes the page; returns the paths of all files."""
        title = html.escape(self.title)
        text = (f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
                f"<title>leonav: {title}</title><style>{CSS}</style></head><body>\n<h1>{title}</h1>\n" + "\n".join(self.body) +
                "\n</body></html>\n")

        def write(path):
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
        self._write(self.out if self.is_file else os.path.join(self.out, "index.html"), write)
        return self.written

    def _write(self, path, write):
        try:
            write(path)
        except OSError as error:
            raise ReportError(f"{path}: {error.strerror}; give another --out") from error
        self.written.append(path)
