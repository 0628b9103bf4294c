"""Check (b): the benchmark box of mirror, glass and chalk balls: its mean, and the caustic under the glass ball.

The mean of this geometry was measured in several renderers. The caustic is compared along three rows of pixels with a path tracer,
which finds it only by hitting the lamp through the ball by chance: slow, but without bias.
"""

import numpy as np

from pictures import write_triptych
from scenes import prepare, scene_name
from statistics_of_seeds import compare_means, mean_and_error

SIZE = 512
MAX_DEPTH = 20
SEEDS = 4
PASSES = 16
PHOTONS = 1 << 19
SPP = 8
RADIUS = 0.3

MEAN = 0.4406
MEAN_NOISE = 0.0004
MEAN_BOUND = 0.005

# x, y, width, height of the rows in pixels, the runs of the path tracer over them, and samples a pixel in each.
CAUSTIC = (352, 443, 96, 3)
CAUSTIC_SEEDS = 16
CAUSTIC_SPP = 1 << 14
PEAK_BOUND = 0.05
PLACE_BOUND = 1


def check(report, foton, mitsuba, scene, out):
    """Adds the rows of one scene to the report and writes its pictures."""
    name = scene_name(scene)
    print(f"{name}: {SIZE}×{SIZE}, {SEEDS} seeds", flush=True)
    prepared = prepare(scene, foton.folder, SIZE, MAX_DEPTH)
    ours = np.stack([foton.render(prepared, seed, PASSES, PHOTONS, SPP, RADIUS) for seed in range(1, SEEDS + 1)])
    reference = mitsuba.render(prepared, 1, 64)
    write_triptych(out / f"{name}.png", ours.mean(axis=0), reference)

    means = ours.mean(axis=(1, 2, 3))
    mean, error = mean_and_error(means)
    report.deviation(f"{name}: mean {mean:.4f} of {MEAN}", mean / MEAN - 1, MEAN_BOUND, np.hypot(error, MEAN_NOISE) / MEAN)
    measured, noise = compare_means(means[:, None], [[reference.mean()], [mitsuba.render(prepared, 2, 64).mean()]])
    report.note(f"{name}: mean against Mitsuba's", f"{measured[0]:+.2%}", f"{noise[0]:.2%}")
    compare_caustic(report, foton, mitsuba, scene, out, ours)


def compare_caustic(report, foton, mitsuba, scene, out, ours):
    """The place and height of the caustic's peak along the rows."""
    name = scene_name(scene)
    x, y, width, height = CAUSTIC
    cropped = prepare(scene, foton.folder, SIZE, MAX_DEPTH, CAUSTIC)
    seeds = range(1, CAUSTIC_SEEDS + 1)
    theirs = np.stack([mitsuba.render(cropped, seed, CAUSTIC_SPP) for seed in seeds])
    ours = ours[:, y : y + height, x : x + width]
    tall = [np.repeat(np.repeat(rows.mean(axis=0), 8, axis=0), 8, axis=1) for rows in (ours, theirs)]
    write_triptych(out / f"{name}-caustic.png", *tall)

    line, error = mean_and_error([profile(image) for image in ours])
    reference, reference_error = mean_and_error([profile(image) for image in theirs])
    place, reference_place = int(line.argmax()), int(reference.argmax())
    noise = np.hypot(error[place] / line[place], reference_error[reference_place] / reference[reference_place])
    peak = f"{name}: caustic peak {line.max():.3f} of {reference.max():.3f}"
    report.deviation(peak, line.max() / reference.max() - 1, PEAK_BOUND, noise)
    own = f"reference σ {reference_error[reference_place] / reference[reference_place]:.2%}"
    shift = place - reference_place
    report.add(f"{name}: caustic peak's place", f"{shift:+d} px", f"±{PLACE_BOUND} px", own, abs(shift) <= PLACE_BOUND)
    rms = np.sqrt(np.mean((line - reference) ** 2)) / reference.mean()
    expected = np.sqrt(np.mean(error**2 + reference_error**2)) / reference.mean()
    report.note(f"{name}: caustic line, RMS difference", f"{rms:.1%}", f"{expected:.1%}")


def profile(rows):
    """Brightness along the rows: mean of rows and channels, then of three neighbours."""
    return np.convolve(rows.mean(axis=(0, 2)), np.full(3, 1 / 3), mode="valid")
