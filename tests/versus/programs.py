"""The programs: what each has after how many processor seconds, as a list of (seconds, image)."""

import json
import os
import signal
import subprocess
import time
from pathlib import Path

import mitsuba
import numpy as np

from foton import read_image
from mitsuba_side import choose_variant
from taking_apart import take_apart

# Samples a pixel that Mitsuba traces at a time.
AT_ONCE = 4


def by_foton(foton, scene, seconds, seed, options):
    """foton, by a method and options of its own; an image after each power of two of passes, and the last."""
    image = foton.folder / "course.exr"
    for old in foton.folder.glob("course*.exr"):
        old.unlink()
    command = ["render", scene, "-o", image, "--json", "--every", "pow2", "--passes", 10**9, "--seed", seed, *options]
    child = subprocess.Popen(
        [str(part) for part in (foton.program, *command)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    spent, is_ended = {}, False
    for line in child.stdout:
        event = json.loads(line)
        if event["event"] == "pass":
            spent[event["pass"]] = processor_seconds(child.pid)
            if spent[event["pass"]] >= seconds and not is_ended:
                is_ended = True
                child.send_signal(signal.SIGINT)
    said = child.stderr.read()
    if child.wait() not in (0, 130) or not spent:
        raise SystemExit(f"foton failed:\n{said}")
    course = []
    for number, at in spent.items():
        on_the_way = image.with_name(f"course-{number:06}.exr")
        path = image if number == max(spent) else on_the_way
        if path.exists():
            course.append((at, read_image(path)))
    return course


def processor_seconds(process):
    """Of all threads of a process so far."""
    fields = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def by_mitsuba(scene, seconds):
    """Mitsuba's path tracer; its kernels are compiled before its time begins."""
    mitsuba.set_variant(choose_variant())
    loaded = mitsuba.load_file(str(scene), integrator="path")
    render = lambda seed: np.array(mitsuba.render(loaded, seed=seed, spp=AT_ONCE), dtype=np.float64)[..., :3]  # noqa: E731
    render(0)
    begin, sum_, count, course = time.process_time(), 0.0, 0, []
    while True:
        count += 1
        sum_ = sum_ + render(count)
        spent = time.process_time() - begin
        if count & (count - 1) == 0 or spent >= seconds:
            course.append((spent, sum_ / count))
        if spent >= seconds:
            print(f"  Mitsuba path: {AT_ONCE * count} samples a pixel", flush=True)
            return course


def by_luxcore(python, folder, scene, size, seconds):
    """LuxCore in a process of its own; raises `NotHanded` for a scene that it cannot be given."""
    parts, images = folder / "scene.npz", folder / "luxcore.npz"
    take_apart(scene, size, parts)
    script = Path(__file__).resolve().parent / "luxcore_side.py"
    done = subprocess.run(
        [str(python), str(script), str(parts), str(seconds), str(images)], capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        raise SystemExit(f"LuxCore failed:\n{done.stdout}{done.stderr}")
    print("\n".join(f"  {line}" for line in done.stdout.splitlines() if line.startswith("LuxCore: ")), flush=True)
    found = np.load(images)
    return [(float(at), found[f"image{i}"].astype(np.float64)) for i, at in enumerate(found["seconds"])]
