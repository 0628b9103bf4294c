"""A reference image by Mitsuba 3's path tracer: SCENE WIDTH HEIGHT SAMPLES IMAGE.exr. `cargo xtask bench to-error --mitsuba` runs it."""

import sys
from pathlib import Path

import mitsuba
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "conformance"))

from mitsuba_side import choose_variant  # noqa: E402

# Samples of one call: more would not fit into memory.
AT_ONCE = 64


def main():
    """Renders and writes."""
    scene, width, height, samples, image = sys.argv[1:]
    mitsuba.set_variant(choose_variant())
    loaded = mitsuba.load_file(scene, integrator="path", resx=int(width), resy=int(height))
    calls = max(1, int(samples) // AT_ONCE)
    sum_ = 0.0
    for seed in range(calls):
        sum_ = sum_ + np.array(mitsuba.render(loaded, seed=seed, spp=AT_ONCE), dtype=np.float64)[..., :3]
    mitsuba.Bitmap((sum_ / calls).astype(np.float32)).write(image)


if __name__ == "__main__":
    main()
