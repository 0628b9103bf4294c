"""Writes what was compared as one PNG: foton, the reference, and their relative difference (red: foton is brighter).

The difference is of images averaged over 5×5 pixels, since the noise of single pixels would drown all else.
"""

import mitsuba
import numpy as np

FULL_SCALE = 0.1
BLUR = 5
GAP = 4


def write_triptych(path, ours, theirs):
    """`FULL_SCALE` of relative difference is full colour."""
    exposure = 0.7 / np.percentile(theirs, 95)
    grey, reference = blurred(ours.mean(axis=2)), blurred(theirs.mean(axis=2))
    difference = (grey - reference) / np.maximum(reference, 0.02 / exposure)
    strength = np.clip(np.abs(difference) / FULL_SCALE, 0, 1)[..., None]
    colour = np.where(difference[..., None] > 0, [0.75, 0.05, 0.05], [0.05, 0.15, 0.8])
    panels = [encode(ours * exposure), encode(theirs * exposure), 1 - strength * (1 - colour)]
    axis = 0 if ours.shape[1] > 4 * ours.shape[0] else 1
    gap = np.ones_like(panels[0]).take(range(GAP), axis)
    row = np.concatenate([panels[0], gap, panels[1], gap, panels[2]], axis)
    mitsuba.Bitmap((row * 255 + 0.5).astype(np.uint8)).write(str(path))


def write_strip(path, images):
    """Images side by side at one exposure, that of the first."""
    exposure = 0.7 / np.percentile(images[0], 95)
    gap = np.ones_like(images[0][:, :GAP])
    row = [part for image in images for part in (gap, encode(image * exposure))][1:]
    mitsuba.Bitmap((np.concatenate(row, axis=1) * 255 + 0.5).astype(np.uint8)).write(str(path))


def encode(linear):
    """Linear to sRGB, clipped."""
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def blurred(grey):
    """The mean over BLUR×BLUR pixels; the border is repeated."""
    padded = np.pad(grey, BLUR // 2, mode="edge")
    return np.lib.stride_tricks.sliding_window_view(padded, (BLUR, BLUR)).mean(axis=(2, 3))
