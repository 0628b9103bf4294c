"""foton, Mitsuba 3 and LuxCore on one scene for the same wall time: `cargo xtask versus [--seconds N]` runs this folder.

Each program renders the benchmark box alone on the machine. Errors are against the mean of long runs of foton with other seeds and other eye samples, whose own noise is quoted. Mitsuba's kernels are
compiled before its time begins; LuxCore's balls are made of triangles.
"""

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "conformance"))

import mitsuba  # noqa: E402
from foton import Foton, read_image  # noqa: E402
from mitsuba_side import choose_variant  # noqa: E402
from pictures import write_strip  # noqa: E402
from scenes import prepare  # noqa: E402
from taking_apart import take_apart  # noqa: E402

SIZE = 256
MAX_DEPTH = 20
SPP = 4
REFERENCE_SEEDS = 8
# The bright spot below the glass ball, in pixels of the image: x, y, width, height.
SPOT = (180, 205, 55, 30)
# Pixels that see the lamp, and their neighbours, say more of filters than of light.
LAMP = 5.0


def main():
    """Renders, prints the table, writes pictures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--foton", type=Path, required=True, help="the program")
    parser.add_argument("--repository", type=Path, required=True, help="where assets/ is")
    parser.add_argument("--out", type=Path, required=True, help="folder for pictures and the cached reference")
    parser.add_argument("--luxcore", type=Path, help="a Python that has pyluxcore")
    parser.add_argument("--seconds", type=float, default=30.0, help="wall time of each program")
    parser.add_argument("--reference-seconds", type=float, default=300.0, help="wall time of the reference, all seeds together")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    foton = Foton(options.foton, options.out / "work")
    scene = prepare(options.repository / "assets/box-spheres/scene.xml", foton.folder, SIZE, MAX_DEPTH)

    reference, noise = long_run(foton, scene, options)
    images = {"foton": timed(foton, scene, options.seconds, 1), "Mitsuba path": path_traced(scene, options.seconds)}
    if options.luxcore is None:
        print("LuxCore: pyluxcore is not installed")
    else:
        images["LuxCore BIDIRVM"] = by_luxcore(options, scene)
    show(images, reference, noise, options)


def timed(foton, scene, seconds, seed):
    """What foton has after so many seconds from the start of its eye pass."""
    image = foton.folder / f"versus-s{seed}.exr"
    spent = ["--time", f"{seconds}s", "--seed", seed, "--spp", SPP]
    foton.run("render", scene, "-o", image, "--direct", "shadow-rays", *spent)
    return read_image(image)


def long_run(foton, scene, options):
    """(mean image, its standard error a pixel) over seeds."""
    cached = options.out / f"reference-{options.reference_seconds:.0f}s.npy"
    if not cached.exists():
        seconds = options.reference_seconds / REFERENCE_SEEDS
        print(f"reference: {REFERENCE_SEEDS} seeds of {seconds:.0f} s", flush=True)
        np.save(cached, np.stack([timed(foton, scene, seconds, 100 + seed) for seed in range(REFERENCE_SEEDS)]))
    runs = np.load(cached)
    return runs.mean(axis=0), runs.std(axis=0, ddof=1) / np.sqrt(len(runs))


def path_traced(scene, seconds):
    """Mitsuba's path tracer, 16 samples a pixel at a time."""
    mitsuba.set_variant(choose_variant())
    loaded = mitsuba.load_file(str(scene), integrator="path")
    render = lambda seed: np.array(mitsuba.render(loaded, seed=seed, spp=16), dtype=np.float64)[..., :3]  # noqa: E731
    render(0)
    begin, sum_, count = time.monotonic(), 0.0, 0
    while time.monotonic() - begin < seconds:
        count += 1
        sum_ = sum_ + render(count)
    print(f"Mitsuba path: {16 * count} samples a pixel", flush=True)
    return sum_ / count


def by_luxcore(options, scene):
    """LuxCore in a process of its own."""
    parts, image = options.out / "work" / "scene.npz", options.out / "work" / "luxcore.npy"
    take_apart(scene, (SIZE, SIZE), MAX_DEPTH, parts)
    script = Path(__file__).resolve().parent / "luxcore_side.py"
    command = [str(options.luxcore), str(script), str(parts), str(options.seconds), str(image)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"LuxCore failed:\n{done.stdout}{done.stderr}")
    print("\n".join(line for line in done.stdout.splitlines() if line.startswith("LuxCore: ")), flush=True)
    return np.load(image).astype(np.float64)


def show(images, reference, noise, options):
    """The table and the pictures."""
    luminance = lambda image: image @ np.array([0.2126, 0.7152, 0.0722])  # noqa: E731
    truth = luminance(reference)
    x, y, width, height = SPOT
    spot = np.zeros_like(truth, dtype=bool)
    spot[y : y + height, x : x + width] = True
    lit = ~grown(truth > LAMP, 2)
    rms = lambda values: float(np.sqrt(np.mean(np.square(values))))  # noqa: E731
    print(f"\nbox-spheres, {SIZE}×{SIZE}, {options.seconds:.0f} s each; luminance")
    print(f"{'':18} {'mean':>8} {'RMSE':>9} {'RMSE in the spot':>17} {'median error elsewhere':>23}")
    rows = {}
    for name, image in images.items():
        error = luminance(image) - truth
        row = [luminance(image)[lit].mean() / truth[lit].mean() - 1, rms(error[lit]), rms(error[spot])]
        row.append(float(np.median(np.abs(error[lit & ~spot]))))
        rows[name] = row
        print(f"{name:18} {row[0]:>+8.2%} {row[1]:>9.4f} {row[2]:>17.4f} {row[3]:>23.4f}")
    own = luminance(noise)
    print(f"{'the reference':18} {'':8} {rms(own[lit]):>9.4f} {rms(own[spot]):>17.4f} {np.median(own[lit]):>23.4f}  (its noise)")
    (options.out / "versus.json").write_text(json.dumps({"seconds": options.seconds, "rows": rows}, indent=1))
    write_strip(options.out / "versus.png", [reference, *images.values()])
    print(f"pictures, from the left: the reference, {', '.join(images)}: {options.out / 'versus.png'}")


def grown(mask, pixels):
    """The mask and what lies within some pixels of it."""
    for _ in range(pixels):
        padded = np.pad(mask, 1)
        mask = mask | padded[2:, 1:-1] | padded[:-2, 1:-1] | padded[1:-1, 2:] | padded[1:-1, :-2]
    return mask


if __name__ == "__main__":
    main()
