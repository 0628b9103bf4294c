"""How far an image is from the reference: luminance, over the reference's mean.

Pixels that see an emitter brighter than white, and their neighbours, say more of filters than of light and are left out; so are the
brightest of the rest.
"""

import numpy as np

# White over the mean of what is not: the live error of foton counts emitters as no brighter than that.
WHITE = 5.0
TRIMMED = 0.005


def luminance(image):
    """By pixel."""
    return image @ np.array([0.2126, 0.7152, 0.0722])


class Judge:
    """A reference and the pixels that count; `emitters` has what is seen of them, directly."""

    def __init__(self, runs, emitters):
        runs = np.stack([luminance(run) for run in runs])
        self.truth = runs.mean(axis=0)
        seen = luminance(emitters)
        kept = ~grown(seen > WHITE * self.truth[seen <= 0].mean())
        kept &= self.truth <= np.quantile(self.truth[kept], 1 - TRIMMED)
        self.kept, self.mean = kept, self.truth[kept].mean()
        self.noise = float(np.sqrt((runs.var(axis=0, ddof=1) / len(runs))[kept].mean()) / self.mean)

    def error(self, image):
        """Root mean square, over the mean."""
        return float(np.sqrt(np.mean((luminance(image) - self.truth)[self.kept] ** 2)) / self.mean)

    def deviation(self, image):
        """Of the mean."""
        return float(luminance(image)[self.kept].mean() / self.mean - 1)


def grown(mask):
    """The mask with its neighbours."""
    padded = np.pad(mask, 1)
    rows = padded[:-2] | padded[1:-1] | padded[2:]
    return rows[:, :-2] | rows[:, 1:-1] | rows[:, 2:]
