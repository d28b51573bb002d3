"""The figures of `pointgi compare` by scikit-image, scipy and numpy, which know nothing of this project.

Usage: independent_measures.py A.exr B.exr ...      pairs of pictures
Prints a line of JSON a pair, with the keys of `pointgi compare --json`.
Exit code 77: a package is not installed (pip install scikit-image OpenEXR).
"""
import json
import sys

try:
    import numpy as np
    import OpenEXR
    from scipy.ndimage import gaussian_filter
    from skimage.metrics import mean_squared_error, structural_similarity
except ImportError:
    sys.exit(77)

WINDOW = 11  # pixels a side of SSIM's window: scipy cuts a Gaussian of 1.5 off at 3.5 of its deviations


def read(path):
    """R, G and B [height, width, 3] and the first pixel (x, y), counted from the corner of the displayWindow."""
    file = OpenEXR.File(path, separate_channels=True)
    channels, header = file.channels(), file.header()
    pixels = np.stack([np.asarray(channels[c].pixels, np.float64) for c in "RGB"], -1)
    return pixels, np.array(header["dataWindow"][0]) - np.array(header["displayWindow"][0])


def common_area(a, begin_a, b, begin_b):
    def end(picture, begin):
        return begin + picture.shape[1::-1]

    begin = np.maximum(begin_a, begin_b)
    stop = np.minimum(end(a, begin_a), end(b, begin_b))

    def cut(picture, first):
        (x0, y0), (x1, y1) = begin - first, stop - first
        return picture[y0:y1, x0:x1]

    return cut(a, begin_a), cut(b, begin_b), [int(x) for x in (begin[0], stop[0], begin[1], stop[1])]


def percentile(values):
    return float(np.percentile(values, 99, method="inverted_cdf"))


def displayed(values, finite, white):
    """IEC 61966-2-1, 0 where a pixel is left out."""
    linear = np.clip(np.where(finite, values, 0.0) / white, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def similarity(x, y):
    if min(x.shape) >= WINDOW:
        return structural_similarity(x, y, data_range=1.0, gaussian_weights=True, sigma=1.5, use_sample_covariance=False)

    # scikit-image has no similarity of pictures smaller than its window. Here the part of the window that lies inside
    # the picture counts, along the sides that are too short for a whole one.
    def blur(values):
        return gaussian_filter(values, 1.5, mode="constant", truncate=3.5)

    weight = blur(np.ones_like(x))
    mean_x, mean_y, xx, yy, xy = (blur(v) / weight for v in (x, y, x * x, y * y, x * y))
    found = ((2 * mean_x * mean_y + 0.01**2) * (2 * (xy - mean_x * mean_y) + 0.03**2) /
             ((mean_x**2 + mean_y**2 + 0.01**2) * (xx - mean_x**2 + yy - mean_y**2 + 0.03**2)))
    whole = tuple(slice(WINDOW // 2, size - WINDOW // 2) if size >= WINDOW else slice(None) for size in x.shape)
    return found[whole].mean()


def figures(a, b, finite, eps, white):
    """Of channels [height, width, channels]."""
    x, y = a[finite].ravel(), b[finite].ravel()
    mean_x, mean_y = float(x.mean()), float(y.mean())
    bias = 0.0 if mean_x == mean_y else (mean_x - mean_y) / mean_y if mean_y != 0.0 else None
    return {"mean_a": mean_x, "mean_b": mean_y, "mse": float(mean_squared_error(y, x)),
            "rel_mse": float(((x - y)**2 / (y**2 + eps)).mean()), "bias": bias, "p99": percentile(np.abs(x - y)),
            "ssim": float(np.mean([similarity(displayed(a[..., k], finite, white), displayed(b[..., k], finite, white))
                                   for k in range(a.shape[-1])]))}


def compared(path_a, path_b):
    a, b, area = common_area(*read(path_a), *read(path_b))
    finite = np.isfinite(a).all(-1) & np.isfinite(b).all(-1)
    mean = b[finite].mean()
    eps = 0.01 * mean**2 if mean != 0.0 else 0.01
    white = percentile(b[finite])
    white = white if white > 0.0 else 1.0
    result = {"area": area, "pixels": int(finite.sum()), "not_finite": int((~finite).sum()), "eps": float(eps),
              "white": white, "all": figures(a, b, finite, eps, white)}
    for k, name in enumerate("RGB"):
        result[name] = figures(a[..., k:k + 1], b[..., k:k + 1], finite, eps, white)
    return result


for first, second in zip(sys.argv[1::2], sys.argv[2::2]):
    with np.errstate(invalid="ignore"):
        print(json.dumps(compared(first, second)))
