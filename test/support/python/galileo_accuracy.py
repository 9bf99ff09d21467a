"""Galileo's signal-in-space accuracy as its messages have it (OS SIS ICD 2.1, table 84)."""
import math


def sisa_index(metres):
    """The index of the smallest accuracy that is not below `metres`; 255: no prediction."""
    for first, step, base in ((0, 0.01, 0.0), (50, 0.02, 0.5), (75, 0.04, 1.0), (100, 0.16, 2.0)):
        index = first + math.ceil((metres - base) / step - 1e-9)
        if index < {0: 50, 50: 75, 75: 100, 100: 126}[first]:
            return max(index, first)
    return 255
