"""LuxCore's part, run by the Python that has it: `luxcore_side.py SCENE.npz SECONDS OUT.npz`.

Renders what `__main__.py` took apart with BIDIRVMCPU, bidirectional path tracing with vertex merging, which photon mapping is a part
of, and writes linear images as (height, width, 3) float32, with the processor seconds after which each was there.
"""

import json
import sys
import time

import numpy as np
import pyluxcore


def main():
    """Reads, renders for so many seconds, writes."""
    scene_file, seconds, out = sys.argv[1], float(sys.argv[2]), sys.argv[3]
    parts = np.load(scene_file, allow_pickle=False)
    described = json.loads(str(parts["description"]))
    width, height = described["size"]
    pyluxcore.Init()
    scene = pyluxcore.Scene()
    scene.Parse(properties(camera(described["camera"], width, height)))
    for i, shape in enumerate(described["shapes"]):
        triangles(scene, f"mesh{i}", parts[f"positions{i}"], parts[f"faces{i}"], parts[f"normals{i}"])
        scene.Parse(properties(material(f"material{i}", shape)))
        named = {f"scene.objects.object{i}.shape": f"mesh{i}", f"scene.objects.object{i}.material": f"material{i}"}
        scene.Parse(properties(named))
    settings = {
        "renderengine.type": "BIDIRVMCPU",
        "light.maxdepth": described["max_depth"],
        "path.maxdepth": described["max_depth"],
        "sampler.type": "SOBOL",
        "sampler.sobol.adaptive.strength": 0.0,
        "film.width": width,
        "film.height": height,
        "film.filter.type": "NONE",
        "film.outputs.0.type": "RGB",
        "film.outputs.0.filename": "unused.exr",
        "batch.halttime": 0,
    }
    config = pyluxcore.RenderConfig(properties(settings), scene)
    session = pyluxcore.RenderSession(config)
    session.Start()
    begin, found, due = time.process_time(), {}, seconds / 32
    while True:
        time.sleep(0.05)
        spent = time.process_time() - begin
        if spent < due:
            continue
        session.UpdateStats()
        found[spent] = image(session, width, height)
        due = min(max(2 * due, spent), seconds)
        if spent >= seconds:
            break
    rate = session.GetStats().Get("stats.renderengine.total.samplesec").GetFloat()
    # Pairs of an eye path and a light path; what the machine is worth, beside figures from another.
    print(f"LuxCore: {rate / 1e3:.1f} k path pairs/s", flush=True)
    session.Stop()
    images = {f"image{i}": pixels for i, pixels in enumerate(found.values())}
    np.savez(out, seconds=np.array(list(found)), **images)


def image(session, width, height):
    """What the film has."""
    pixels = np.zeros(width * height * 3, dtype=np.float32)
    session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, pixels)
    # Its rows begin at the bottom.
    return pixels.reshape(height, width, 3)[::-1].copy()


def properties(values):
    """A dictionary as LuxCore's properties."""
    made = pyluxcore.Properties()
    for name, value in values.items():
        made.Set(pyluxcore.Property(name, value))
    return made


def camera(described, width, height):
    """A pinhole whose field of view is along the shorter side."""
    aspect = width / height
    window = [-aspect, aspect, -1.0, 1.0] if aspect > 1 else [-1.0, 1.0, -1.0 / aspect, 1.0 / aspect]
    return {
        "scene.camera.type": "perspective",
        "scene.camera.lookat.orig": described["origin"],
        "scene.camera.lookat.target": described["target"],
        "scene.camera.up": described["up"],
        "scene.camera.fieldofview": described["fov"],
        "scene.camera.screenwindow": window,
        "scene.camera.autofocus.enable": 0,
        "scene.camera.lensradius": 0.0,
    }


def material(name, shape):
    """A material, and its emission if the shape is a lamp."""
    key = f"scene.materials.{name}"
    made = {f"{key}.type": shape["type"]}
    for parameter, value in shape["parameters"].items():
        made[f"{key}.{parameter}"] = value
    if shape["radiance"] is not None:
        made[f"{key}.emission"] = shape["radiance"]
        made[f"{key}.emission.gain"] = [1.0, 1.0, 1.0]
        made[f"{key}.emission.power"] = 0.0
    return made


def triangles(scene, name, positions, faces, normals):
    """Hands a mesh over; normals may be missing."""
    rows = lambda array: [tuple(row) for row in array.tolist()]  # noqa: E731
    scene.DefineMesh(name, rows(positions), rows(faces), rows(normals) if len(normals) else None, None, None, None)


if __name__ == "__main__":
    main()
