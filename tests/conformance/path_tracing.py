"""Check (e): foton's path tracer against Mitsuba's, which estimates the same integral in the same way.

Nothing is left out and nothing is biased: means and blocks agree as far as both are known.
"""

from dataclasses import dataclass

import numpy as np

from scenes import prepare, scene_name
from statistics_of_seeds import blocks, compare_means, mean_and_error

BLOCK = 8
MEAN_BOUND = 0.004
BLOCK_SHARE = 0.98
SIGMAS = 3.5


@dataclass
class Effort:
    """How much work to do."""

    size: int
    max_depth: int
    seeds: int
    samples: int


QUICK = Effort(128, 16, 4, 64)
FULL = Effort(256, 16, 6, 256)


def check(report, foton, mitsuba, scene, effort):
    """Adds the rows of one scene to the report."""
    name = scene_name(scene)
    print(f"{name} by path tracing: {effort.size}×{effort.size}, {effort.seeds} seeds", flush=True)
    prepared = prepare(scene, foton.folder, effort.size, effort.max_depth)
    seeds = range(1, effort.seeds + 1)
    theirs = np.stack([mitsuba.render(prepared, seed, effort.samples) for seed in seeds])
    ours = np.stack([foton.trace_paths(prepared, seed, effort.samples) for seed in seeds])
    everywhere = [images.mean(axis=(1, 2)) for images in (ours, theirs)]
    deviation, noise = compare_means(*everywhere)
    for channel, measured, error in zip("RGB", deviation, noise):
        report.deviation(f"{name} by path tracing: mean {channel}", measured, MEAN_BOUND, error)

    mean, error = mean_and_error([blocks(image, BLOCK).mean(axis=2) for image in ours])
    reference, reference_error = mean_and_error([blocks(image, BLOCK).mean(axis=2) for image in theirs])
    # Few seeds say little of one block's noise, all blocks together a lot.
    relative = np.sqrt(np.mean((error / mean) ** 2 + (reference_error / reference) ** 2))
    agree = np.abs(mean - reference) <= SIGMAS * relative * reference
    row = f"{name} by path tracing: {agree.size} blocks agree"
    report.share(row, agree.mean(), BLOCK_SHARE, f"block σ {relative:.2%}")
