"""Means and standard errors over images that differ in their seed only."""

import numpy as np


def mean_and_error(samples):
    """(mean, standard error of the mean) over the first axis."""
    samples = np.asarray(samples, dtype=np.float64)
    return samples.mean(axis=0), samples.std(axis=0, ddof=1) / np.sqrt(len(samples))


def masked_mean(images, mask):
    """Channel means over the pixels of `mask`, one row per image."""
    return np.stack([image[mask].mean(axis=0) for image in images])


def compare_means(ours, theirs):
    """(relative deviation of the means, combined relative standard error) for rows of figures, one row a seed."""
    mean, error = mean_and_error(ours)
    reference, reference_error = mean_and_error(theirs)
    return mean / reference - 1, np.hypot(error / mean, reference_error / reference)


def blocks(image, size):
    """Means over size×size blocks; what is left over at the right and bottom is dropped."""
    height, width = image.shape[0] // size, image.shape[1] // size
    cut = image[: height * size, : width * size].astype(np.float64)
    return cut.reshape(height, size, width, size, *image.shape[2:]).mean(axis=(1, 3))
