"""What the package raises and warns of."""


class LeonavError(Exception):
    """A file or message that cannot be read; the text names the file, the byte or line, and the remedy."""


class LeonavWarning(UserWarning):
    """Something was left out of what was read; the text says what, how much and where first."""
