"""What the numbers of an E57 colour mean: 8 bits, 16 bits, or what the file says."""
import numpy as np

from import_scan.e57_node import number


class ColourRange:
    """The value of full brightness, from colorLimits, else from the type that the points are declared with."""

    def __init__(self, scan, field):
        declared = field.scaledMaximum() if hasattr(field, "scaledMaximum") else field.maximum()
        self.full = float(number(scan, "colorLimits/colorRedMaximum", declared))
        if type(field).__name__ == "FloatNode" and not 0 < self.full <= 65535:
            self.full = 1.0
        # Some writers give the brightest value that occurs; limits just below a whole number of bits mean these bits.
        if 1 < self.full <= 255:
            self.full = 255.0
        elif not 0 < self.full < 0.9 * 65535:
            self.full = 65535.0
        self.eight_bit = self.full == 255

    def scaled(self, values, full):
        return np.clip(np.rint(values * (full / self.full)), 0, full)
