"""A scene that Mitsuba has read, as meshes and numbers that other programs can be given.

Knows matt, glass and mirror surfaces, lamps that are surfaces, a pinhole. Anything else is refused by its name, for a scene that is only
nearly the same would prove nothing.
"""

import json

import mitsuba
import numpy as np

# Facets around a ball: at 512 the silhouette is off by less than 2e-5 of the radius.
AROUND = 512


class NotHanded(Exception):
    """What of a scene cannot be told in LuxCore's words."""


def take_apart(prepared, size, path):
    """Writes the prepared scene to `path` (.npz): arrays for each mesh, the rest as JSON. `size` is (width, height, depth)."""
    mitsuba.set_variant("scalar_rgb")
    scene = mitsuba.load_file(str(prepared))
    if len(scene.emitters()) != sum(shape.is_emitter() for shape in scene.shapes()):
        raise NotHanded("no way to hand emitters over that are no surfaces")
    arrays, shapes = {}, []
    for i, shape in enumerate(scene.shapes()):
        positions, faces, normals = mesh(shape)
        arrays |= {f"positions{i}": positions, f"faces{i}": faces, f"normals{i}": normals}
        shapes.append(material(shape))
    described = {"size": list(size[:2]), "max_depth": size[2], "shapes": shapes, "camera": camera(scene.sensors()[0])}
    np.savez(path, description=np.array(json.dumps(described)), **arrays)


def mesh(shape):
    """(positions, faces, normals) of a shape; no normals where it is flat."""
    parameters = mitsuba.traverse(shape)
    if "vertex_positions" in parameters:
        rows = lambda name, kind: np.array(parameters[name], dtype=kind).reshape(-1, 3)  # noqa: E731
        return rows("vertex_positions", np.float32), rows("faces", np.int32), rows("vertex_normals", np.float32)
    kind = str(shape).split("[")[0]
    to_world = np.array(parameters["to_world"].matrix, dtype=np.float64).reshape(4, 4)
    if kind == "Rectangle":
        corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], dtype=np.float64)
        faces = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32)
        return moved(corners, to_world), faces, np.zeros((0, 3), dtype=np.float32)
    if kind == "Sphere":
        return ball(to_world)
    raise NotHanded(f"{shape.id()}: no way to hand a {kind} over")


def ball(to_world):
    """A sphere as triangles with its true normals."""
    rows = AROUND // 2
    theta = np.linspace(0, np.pi, rows + 1)[:, None]
    phi = np.linspace(0, 2 * np.pi, AROUND, endpoint=False)[None, :]
    unit = np.stack(np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)), axis=-1)
    unit = unit.reshape(-1, 3)
    i, j = np.meshgrid(np.arange(rows), np.arange(AROUND), indexing="ij")
    at = lambda row, column: (row * AROUND + column % AROUND).ravel()  # noqa: E731
    first = np.stack([at(i, j), at(i + 1, j), at(i + 1, j + 1)], axis=1)
    second = np.stack([at(i, j), at(i + 1, j + 1), at(i, j + 1)], axis=1)
    # At the poles one of the two has no area.
    faces = np.concatenate([first[: -AROUND], second[AROUND:]]).astype(np.int32)
    normals = unit / np.linalg.norm(unit, axis=1, keepdims=True)
    return moved(unit, to_world), faces, normals.astype(np.float32)


def moved(points, to_world):
    """Points in the world."""
    return (points @ to_world[:3, :3].T + to_world[:3, 3]).astype(np.float32)


def material(shape):
    """Type and parameters in LuxCore's words, and what the shape emits."""
    bsdf = shape.bsdf()
    text = str(bsdf)
    values = {name.removeprefix("brdf_0."): value for name, value in mitsuba.traverse(bsdf)}
    rgb = lambda name: [float(v) for v in np.broadcast_to(np.array(values[name]).ravel(), 3)]  # noqa: E731
    if "Diffuse[" in text or "SmoothDiffuse" in text:
        kind, parameters = "matte", {"kd": rgb("reflectance.value")}
    elif "SmoothDielectric" in text:
        eta = float(values["eta"])
        kind, parameters = "glass", {"kr": [1.0] * 3, "kt": [1.0] * 3, "interiorior": eta, "exteriorior": 1.0}
    elif "SmoothConductor" in text:
        kind, parameters = "mirror", {"kr": rgb("specular_reflectance.value")}
    else:
        raise NotHanded(f"{shape.id()}: no way to hand this material over: {text.split('[')[0]}")
    emitter = shape.emitter()
    radiance = None
    if emitter is not None:
        [radiance] = [np.array(v).ravel()[:3].tolist() for name, v in mitsuba.traverse(emitter) if "radiance" in name]
    return {"type": kind, "parameters": parameters, "radiance": radiance}


def camera(sensor):
    """Where it stands and looks, and its field of view in degrees along the shorter side, for square films."""
    values = mitsuba.traverse(sensor)
    m = np.array(values["to_world"].matrix, dtype=np.float64).reshape(4, 4)
    origin, forward, up = m[:3, 3], m[:3, 2], m[:3, 1]
    size = sensor.film().size()
    if int(size[0]) != int(size[1]):
        raise NotHanded("only square films can be compared")
    fov = float(np.array(values["x_fov"]).ravel()[0])
    return {"origin": origin.tolist(), "target": (origin + forward).tolist(), "up": up.tolist(), "fov": fov}
