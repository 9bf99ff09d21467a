"""What leonav-report raises where it cannot go on."""


class ReportError(Exception):
    """A file or a command line that cannot be used; the text names the file, the line and the remedy."""
