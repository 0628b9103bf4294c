"""Check (c): the same scenes cut off after 2, 3 and 5 edges. A path counted one edge too long or too short shows here at once."""

import numpy as np

from diffuse_box import lamp_pixels
from scenes import prepare, scene_name
from statistics_of_seeds import compare_means, masked_mean

DEPTHS = (2, 3, 5)
SIZE = 256
SEEDS = 4
REFERENCE_SPP = 256
PASSES = 16
PHOTONS = 1 << 17
SPP = 16
BOUND = 0.01


def check(report, foton, mitsuba, scenes):
    """Adds a row per scene and depth."""
    seeds = range(1, SEEDS + 1)
    for scene in scenes:
        seen = ~lamp_pixels(mitsuba, scene, foton.folder, SIZE)
        for depth in DEPTHS:
            prepared = prepare(scene, foton.folder, SIZE, depth)
            theirs = [mitsuba.render(prepared, seed, REFERENCE_SPP) for seed in seeds]
            ours = [foton.render(prepared, seed, PASSES, PHOTONS, SPP) for seed in seeds]
            means = [np.mean(masked_mean(images, seen), axis=1, keepdims=True) for images in (ours, theirs)]
            deviation, noise = compare_means(*means)
            report.deviation(f"{scene_name(scene)}: mean at depth {depth}", deviation[0], BOUND, noise[0])
