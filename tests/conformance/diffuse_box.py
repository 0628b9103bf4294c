"""Check (a): a box without anything specular against a path tracer, pixel block by pixel block.

Pixels that see the lamp are left out: they are exact in both programs and would hide the rest. Blocks that touch a pixel within
2 r0 of an edge are held against what the share of their photon discs on the surface predicts (see geometry.py): there photon
mapping is dark by design.
"""

from dataclasses import dataclass

import numpy as np

from geometry import disc_offsets, disc_share, ring_offsets, squared_radii
from pictures import write_triptych
from scenes import prepare, scene_name
from statistics_of_seeds import blocks, compare_means, masked_mean, mean_and_error

BLOCK = 8
MEAN_BOUND = 0.01
BLOCK_SHARE = 0.99
SIGMAS = 3
SLACK = 0.02
EDGE_BOUND = 0.01
DISC_SAMPLES = 24


@dataclass
class Effort:
    """How much work to do. `radius` is r0 in world units; the boxes are 2 units wide."""

    size: int
    max_depth: int
    seeds: int
    reference_spp: int
    passes: int
    photons: int
    spp: int
    radius: float


QUICK = Effort(128, 16, 4, 128, 16, 1 << 18, 16, 0.016)
FULL = Effort(256, 16, 4, 512, 32, 1 << 18, 16, 0.012)


def check(report, foton, mitsuba, scene, out, effort):
    """Adds the rows of one scene to the report and writes its picture."""
    name = scene_name(scene)
    print(f"{name}: {effort.size}×{effort.size}, {effort.seeds} seeds", flush=True)
    prepared = prepare(scene, foton.folder, effort.size, effort.max_depth)
    seeds = range(1, effort.seeds + 1)
    theirs = np.stack([mitsuba.render(prepared, seed, effort.reference_spp) for seed in seeds])
    ours = np.stack([render(foton, prepared, seed, effort) for seed in seeds])
    write_triptych(out / f"{name}.png", ours.mean(axis=0), theirs.mean(axis=0))

    seen = ~lamp_pixels(mitsuba, scene, foton.folder, effort.size)
    deviation, noise = compare_means(masked_mean(ours, seen), masked_mean(theirs, seen))
    for channel, measured, error in zip("RGB", deviation, noise):
        report.deviation(f"{name}: mean {channel}", measured, MEAN_BOUND, error)

    circle, share = disc_shares(mitsuba, prepared, effort)
    compare_blocks(report, name, ours, theirs, seen, circle < 1, share)


def render(foton, prepared, seed, effort):
    """One foton image."""
    return foton.render(prepared, seed, effort.passes, effort.photons, effort.spp, effort.radius)


def disc_shares(mitsuba, prepared, effort):
    """For each pixel the share on the surface of the circle of radius 2 r0, and that of the discs the passes use, r shrinking."""
    passes = np.arange(DISC_SAMPLES) * effort.passes // DISC_SAMPLES
    discs = {
        "circle": (2 * effort.radius, ring_offsets(DISC_SAMPLES // 2)),
        "disc": (effort.radius, disc_offsets(squared_radii(effort.passes)[passes])),
    }
    shares = []
    for what, (radius, offsets) in discs.items():

        def make(radius=radius, offsets=offsets):
            with mitsuba.scalar_scene(prepared) as scene:
                return disc_share(scene, effort.size, radius, offsets)

        shares.append(mitsuba.cached(prepared, f"{what}-r{effort.radius}-p{effort.passes}", make))
    return shares


def lamp_pixels(mitsuba, scene, folder, size):
    """Pixels in which a lamp is seen, and their neighbours, since the two programs sample pixels at different places."""
    emission_only = prepare(scene, folder, size, 1)
    lit = mitsuba.render(emission_only, 0, 64).max(axis=2) > 0
    grown = lit.copy()
    for axis in (0, 1):
        grown = grown | np.roll(grown, 1, axis) | np.roll(grown, -1, axis)
    return grown


def compare_blocks(report, name, ours, theirs, seen, creased, share):
    """Blocks away from edges against the bound; those at edges against the prediction."""
    whole = blocks(seen, BLOCK) == 1
    smooth = whole & (blocks(creased, BLOCK) == 0)
    mean, error = mean_and_error([blocks(image, BLOCK) for image in ours])
    reference, reference_error = mean_and_error([blocks(image, BLOCK) for image in theirs])
    sigma = pooled(np.hypot(error, reference_error))
    agree = (np.abs(mean - reference) <= SIGMAS * sigma + SLACK * reference).all(axis=2)
    typical = f"block σ {np.median(sigma[smooth] / reference[smooth]):.2%}"
    report.share(f"{name}: {smooth.sum()} blocks away from edges agree", agree[smooth].mean(), BLOCK_SHARE, typical)

    edged = whole & ~smooth
    predicted = mean_and_error([blocks(image * share[..., None], BLOCK) for image in theirs])[0]
    dark = mean[edged].sum() / reference[edged].sum()
    expected = predicted[edged].sum() / reference[edged].sum()
    noise = np.sqrt((sigma[edged] ** 2).sum()) / reference[edged].sum()
    row = f"{name}: {edged.sum()} blocks at edges, {expected - 1:+.2%} predicted"
    good = abs(dark / expected - 1) <= EDGE_BOUND
    report.add(row, f"{dark - 1:+.2%}", f"±{EDGE_BOUND:.1%} of it", f"{noise:.2%}", good)


def pooled(sigma):
    """The RMS of each figure and its neighbours': few seeds say little of one block's noise, and neighbours have nearly the same."""
    padded = np.pad(sigma**2, ((1, 1), (1, 1), (0, 0)), mode="edge")
    height, width = sigma.shape[:2]
    shifted = [padded[y : y + height, x : x + width] for y in range(3) for x in range(3)]
    return np.sqrt(np.mean(shifted, axis=0))
