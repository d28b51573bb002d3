"""Nodes of an E57 file that may be missing."""
import numpy as np


def child(node, path):
    """The node at a path such as "pose/rotation", or None."""
    for name in path.split("/"):
        if not node.isDefined(name):
            return None
        node = node[name]
    return node


def number(node, path, otherwise):
    """The value of a number, or `otherwise`."""
    found = child(node, path)
    if found is None:
        return otherwise
    return found.scaledValue() if hasattr(found, "scaledValue") else found.value()


def pose_of(node):
    """(rotation [3 x 3], translation [3]) from the scan's frame to the file's; the identity where it is missing."""
    w, x, y, z = (number(node, "pose/rotation/" + name, 1.0 if name == "w" else 0.0) for name in "wxyz")
    translation = np.array([number(node, "pose/translation/" + name, 0.0) for name in "xyz"], "d")
    length = np.sqrt(w * w + x * x + y * y + z * z)
    if not np.isfinite(length) or length == 0:
        return np.eye(3), translation
    w, x, y, z = (value / length for value in (w, x, y, z))
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]), translation
