"""Mitsuba's part: reference images, cached because they cost minutes, and rays against the scene's geometry."""

import glob
import hashlib
import os
import re
from contextlib import contextmanager

import mitsuba
import numpy as np

# LLVM 15 aborts on an instruction that Mitsuba 3.9 emits; 19 works and is three times as fast as the scalar variant.
OLDEST_LLVM = 19


def choose_variant():
    """The fast variant where a good LLVM is installed, else the one that always works."""
    if "DRJIT_LIBLLVM_PATH" not in os.environ:
        found = {}
        for path in glob.glob("/usr/lib/*/libLLVM*.so*"):
            version = re.search(r"libLLVM(?:-|\.so\.)(\d+)", path)
            if version and int(version.group(1)) >= OLDEST_LLVM:
                found[int(version.group(1))] = path
        if not found:
            return "scalar_rgb"
        os.environ["DRJIT_LIBLLVM_PATH"] = found[max(found)]
    return "llvm_ad_rgb"


class Mitsuba:
    """Renders references into `cache` and keeps them there as .npy files."""

    def __init__(self, cache, folder):
        self.cache = cache
        self.folder = folder
        self.variant = choose_variant()
        self.version = mitsuba.__version__
        mitsuba.set_variant(self.variant)
        cache.mkdir(parents=True, exist_ok=True)

    def render(self, prepared, seed, spp):
        """The `path` image of a prepared scene as (height, width, 3) float64."""

        def image():
            scene = mitsuba.load_file(str(prepared), integrator="path")
            return np.array(mitsuba.render(scene, seed=seed, spp=spp), dtype=np.float64)[..., :3]

        return self.cached(prepared, f"path-{spp}spp-s{seed}", image)

    def cached(self, prepared, what, make):
        """`make()`, or what it returned when the same was asked of the same file by the same version."""
        text = prepared.read_text() + what + self.version
        key = hashlib.sha256(text.encode()).hexdigest()[:10]
        path = self.cache / f"{prepared.stem}-{what}-{key}.npy"
        if not path.exists():
            np.save(path, make())
        return np.load(path)

    @contextmanager
    def scalar_scene(self, prepared):
        """The scene in the scalar variant, for rays one by one; puts the rendering variant back at the end."""
        mitsuba.set_variant("scalar_rgb")
        try:
            yield mitsuba.load_file(str(prepared), integrator="path")
        finally:
            mitsuba.set_variant(self.variant)
