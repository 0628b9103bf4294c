"""Check (e): a camera with a lens, `tests/scenes/depth-of-field.xml`, pixel block by pixel block.

Path tracing follows a point of the lens with every sample, progressive photon mapping with its fixed eye samples: both must show what
Mitsuba's `thinlens` shows, near, in focus and far. Blocks that are nearly black, where the floor ends, have too few samples to compare.
"""

import numpy as np

from pictures import write_triptych
from scenes import prepare
from statistics_of_seeds import blocks, compare_means, mean_and_error

BLOCK = 8
MEAN_BOUND = 0.01
BLOCK_BOUND = 0.02
BLOCK_SHARE = {"path": 0.99, "ppm": 0.97}
SIGMAS = 3
DARK = 0.02
SIZE = 160
SEEDS = range(1, 5)
REFERENCE_SPP = 1024


def check(report, foton, mitsuba, repository, out):
    """Adds the rows of both methods."""
    print("depth-of-field", flush=True)
    prepared = prepare(repository / "tests" / "scenes" / "depth-of-field.xml", foton.folder, SIZE, 8)
    theirs = np.stack([mitsuba.render(prepared, seed, REFERENCE_SPP) for seed in SEEDS])
    efforts = {"path": (64, 1, 16), "ppm": (32, 1 << 18, 64)}
    for method, (passes, photons, spp) in efforts.items():
        ours = np.stack([foton.render(prepared, s, passes, photons, spp, direct="auto", method=method) for s in SEEDS])
        write_triptych(out / f"depth-of-field-{method}.png", ours.mean(axis=0), theirs.mean(axis=0))
        means = (images.mean(axis=(1, 2)) for images in (ours, theirs))
        for channel, measured, error in zip("RGB", *compare_means(*means)):
            report.deviation(f"depth of field, {method}: mean {channel}", measured, MEAN_BOUND, error)
        mean, error = mean_and_error([blocks(image, BLOCK) for image in ours])
        reference, reference_error = mean_and_error([blocks(image, BLOCK) for image in theirs])
        bright = (reference > DARK * reference.max()).all(axis=2)
        bound = SIGMAS * np.hypot(error, reference_error) + BLOCK_BOUND * reference
        agree = (np.abs(mean - reference) <= bound).all(axis=2)[bright]
        deviation = np.median(np.abs(mean / np.maximum(reference, 1e-9) - 1)[bright])
        name = f"depth of field, {method}: {bright.sum()} blocks agree"
        report.share(name, agree.mean(), BLOCK_SHARE[method], f"median {deviation:.2%}")
