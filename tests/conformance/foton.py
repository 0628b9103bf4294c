"""Runs the foton program and reads what it wrote."""

import subprocess

import mitsuba
import numpy as np


class Foton:
    """One foton binary; images go to `folder`."""

    def __init__(self, program, folder):
        self.program = program
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)

    def version(self):
        """What the program says of itself."""
        return self.run("--version").strip()

    def render(self, prepared, seed, passes, photons, spp, radius=None, direct="photons", method="ppm", size=None):
        """Renders and returns the image as (height, width, 3) float64. Without a radius or a size the program takes its own."""
        image = self.folder / f"foton-{method}-{prepared.stem}-s{seed}.exr"
        arguments = ["render", prepared, "-o", image, "--passes", passes, "--photons", photons, "--seed", seed]
        arguments += ["--spp", spp, "--integrator", method]
        if method == "ppm":
            arguments += ["--direct", direct]
        if size is not None:
            arguments += ["--size", "x".join(map(str, size))]
        if radius is not None:
            arguments += ["--radius", radius]
        self.run(*arguments)
        return read_image(image)

    def trace_paths(self, prepared, seed, samples):
        """Renders by path tracing with so many samples a pixel; as (height, width, 3) float64."""
        image = self.folder / f"foton-{prepared.stem}-path-s{seed}.exr"
        self.run("render", prepared, "-o", image, "--integrator", "path", "--passes", samples, "--seed", seed)
        return read_image(image)

    def run(self, *arguments):
        """Runs the program; a failure ends everything with its message."""
        command = [str(part) for part in (self.program, *arguments)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise SystemExit(f"{' '.join(command)}\nexited with {done.returncode}:\n{done.stderr}")
        return done.stdout


def read_image(path):
    """The channels R, G, B of an EXR file, whatever other layers it holds."""
    bitmap = mitsuba.Bitmap(str(path))
    pixels = np.array(bitmap, dtype=np.float64).reshape(bitmap.height(), bitmap.width(), -1)
    names = [field.name for field in bitmap.struct_()]
    return pixels[..., [names.index(colour) for colour in "RGB"]]
