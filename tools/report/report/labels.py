"""Places texts in a picture so that none covers another and few points lie beneath."""
import numpy as np
from matplotlib import patheffects
from matplotlib.transforms import Bbox

HALO = [patheffects.withStroke(linewidth=2.5, foreground="white")]
# Where a text may stand around its point, in points of 1/72 inch, with its alignment. The first good one is taken.
PLACES = tuple((reach * dx, reach * dy, "center" if dx == 0 else "left" if dx > 0 else "right",
                "center" if dy == 0 else "bottom" if dy > 0 else "top")
               for reach in (5, 14, 26) for dx, dy in ((1, 0.6), (-1, 0.6), (1, -0.6), (-1, -0.6), (0, 1), (0, -1), (1.2, 0), (-1.2, 0)))


class Labels:
    """The texts of one picture, whose limits and size must be final, and the boxes that they take up, in pixels."""

    def __init__(self, axis, points=None):
        """`points` in the axis' coordinates, as rows x and y, are what texts should not cover."""
        axis.figure.canvas.draw()
        self.axis, self.renderer = axis, axis.figure.canvas.get_renderer()
        self.boxes = []
        points = np.zeros((2, 0)) if points is None else points[:, np.isfinite(points).all(axis=0)]
        self.points = axis.transData.transform(points.T) if points.size else np.zeros((0, 2))

    def reserve(self, box):
        """Keeps a box in pixels free of texts."""
        self.boxes.append(box)

    def covered(self, box):
        """How many points lie in a box."""
        x, y = self.points[:, 0], self.points[:, 1]
        return int(np.sum((x > box.x0) & (x < box.x1) & (y > box.y0) & (y < box.y1)))

    def place(self, x, y, text, must=False, **style):
        """Writes a text beside a point; returns whether there was room. With `must` it is written in any case."""
        inside, best = self.axis.bbox, None
        note = self.axis.annotate(text, (x, y), xytext=(0, 0), textcoords="offset points", annotation_clip=False, zorder=50, **style)
        note.set_path_effects(HALO)
        for dx, dy, horizontal, vertical in PLACES:
            note.xyann = (dx, dy)
            note.set_ha(horizontal)
            note.set_va(vertical)
            box = Bbox.from_extents(*note.get_window_extent(self.renderer).padded(1.5).extents)
            if box.x0 < inside.x0 or box.x1 > inside.x1 or box.y0 < inside.y0 or box.y1 > inside.y1:
                continue
            if any(box.overlaps(other) for other in self.boxes):
                continue
            cost = self.covered(box)
            if best is None or cost < best[0]:
                best = (cost, dx, dy, horizontal, vertical, box)
            if cost == 0:
                break
        if best is None and not must:
            note.remove()
            return False
        if best is not None:
            _, dx, dy, horizontal, vertical, box = best
            note.xyann = (dx, dy)
            note.set_ha(horizontal)
            note.set_va(vertical)
        self.boxes.append(box)
        return True
