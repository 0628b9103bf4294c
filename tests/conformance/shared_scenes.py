"""Check (d): scenes that others made, where a `shared` folder with them lies beside the repository.

- cornell-water with its lamp enlarged until the path tracer finds it through the water: means over squares of the lit floor. Its
  waves are seen at grazing angles, where interpolated normals mirror to below the true surface: Mitsuba lets such paths go on
  under water, foton tips them back above it, and the floor's mean agrees to 0.2 %. (Dropped, they cost the far squares 5 %.)
- ring-glass against light tracing (`ptracer`), which sees caustics on the table but nothing through glass or in gold: two lines
  across the brightest caustics. The faint sky is left out: it would take four photons of five.
- veach-mis against the path tracer: means over each plate and wall, with shadow rays: the plates are so narrow that discs of
  photons overhang their edges, which costs the roughest 3 % and more in 24 passes; a row that stays too noisy to show 2 % says so, and is no
  failure.
"""

import xml.etree.ElementTree as xml
from pathlib import Path

import mitsuba
import numpy as np

from pictures import write_triptych
from scenes import prepare, set_child
from statistics_of_seeds import compare_means, masked_mean, mean_and_error

REGION_BOUND = 0.02
PEAK_BOUND = 0.05
PLACE_BOUND = 1

WATER_SIZE = (192, 192)
LAMP_GROWTH = 3.4
FLOOR_EDGES = ((-0.75, -0.25, 0.25, 0.75), (-0.75, -0.25, 0.25, 0.7))

RING_SIZE = (320, 240)

MIS_SIZE = (320, 180)


def check(report, foton, theirs, shared, out):
    """Adds the rows of all three scenes; does nothing where they are not there."""
    if not shared.is_dir():
        report.note("scenes of others", "not there", "")
        return
    water(report, foton, theirs, shared / "cornell-water" / "scene.xml", out)
    ring(report, foton, theirs, shared / "ring-glass" / "scene.xml", out)
    multiple_importance(report, foton, theirs, shared / "veach-mis" / "scene.xml", out)


def sized(prepared, size):
    """The prepared scene at (width, height)."""
    tree = xml.parse(prepared)
    film = tree.getroot().find("sensor/film")
    set_child(film, "integer", "width", size[0])
    set_child(film, "integer", "height", size[1])
    return save(tree, prepared, "sized")


def save(tree, prepared, word):
    """Writes the tree beside the prepared scene, where relative names still hold."""
    path = prepared.with_name(f"{prepared.stem}-{word}.xml")
    tree.write(path, encoding="unicode")
    return path


def water(report, foton, theirs, scene, out):
    """Means over squares of the floor that is seen through the water."""
    print("cornell-water with a large lamp", flush=True)
    prepared = sized(prepare(scene, foton.folder, WATER_SIZE[0], 12), WATER_SIZE)
    tree = xml.parse(prepared)
    lamp = next(s for s in tree.getroot().iterfind("shape") if s.find("emitter") is not None)
    grow = xml.SubElement(xml.SubElement(lamp, "transform", name="to_world"), "scale")
    grow.attrib.update(x=str(LAMP_GROWTH), z=str(LAMP_GROWTH))
    prepared = save(tree, prepared, "large-lamp")
    reference = np.stack([theirs.render(prepared, seed, 1024) for seed in (1, 2)])
    ours = np.stack([foton.render(prepared, seed, 16, 1 << 18, 8) for seed in (1, 2)])
    write_triptych(out / "shared-cornell-water.png", ours.mean(axis=0), reference.mean(axis=0))
    with theirs.scalar_scene(prepared) as built:
        x, z = seen_through_water(built, WATER_SIZE)
    for i in range(3):
        for j in range(3):
            inside = lambda v, edges, k: (v > edges[k]) & (v < edges[k + 1])  # noqa: E731
            mask = inside(x, FLOOR_EDGES[0], i) & inside(z, FLOOR_EDGES[1], j)
            if mask.sum() < 30:
                continue
            compare(report, f"cornell-water: floor {i + 1},{j + 1} ({mask.sum()} px)", ours, reference, mask)


def compare(report, name, ours, reference, mask):
    """One row for the mean of all channels over a mask."""
    deviation, noise = compare_means(*(masked_mean(images, mask).mean(axis=1, keepdims=True) for images in (ours, reference)))
    if noise[0] > REGION_BOUND / 2 and abs(deviation[0]) < 3 * noise[0]:
        report.note(name, f"{deviation[0]:+.2%}", f"{noise[0]:.2%}, too much to show {REGION_BOUND:.0%}")
    else:
        report.deviation(name, deviation[0], REGION_BOUND, noise[0])


def seen_through_water(scene, size):
    """x and z of the floor that each pixel's centre sees through water alone; NaN elsewhere."""
    x, z = np.full(size[::-1], np.nan), np.full(size[::-1], np.nan)
    for v in range(size[1]):
        for u in range(size[0]):
            ray, _ = scene.sensors()[0].sample_ray(0.0, 0.5, [(u + 0.5) / size[0], (v + 0.5) / size[1]], [0.5, 0.5])
            surface = scene.ray_intersect(ray)
            crossings = 0
            while surface.is_valid() and surface.bsdf(ray).id() == "water" and crossings < 4:
                sample, _ = surface.bsdf(ray).sample(mitsuba.BSDFContext(), surface, 0.9999, [0.5, 0.5])
                ray = surface.spawn_ray(surface.to_world(sample.wo))
                surface = scene.ray_intersect(ray)
                crossings += 1
            if crossings and surface.is_valid() and abs(surface.p.y) < 1e-3:
                x[v, u], z[v, u] = surface.p.x, surface.p.z
    return x, z


def first_shapes(scene, size, pick):
    """`pick(surface)` of what each pixel's centre sees first; an empty word where nothing is."""
    names = np.full(size[::-1], "", dtype=object)
    for v in range(size[1]):
        for u in range(size[0]):
            ray, _ = scene.sensors()[0].sample_ray(0.0, 0.5, [(u + 0.5) / size[0], (v + 0.5) / size[1]], [0.5, 0.5])
            surface = scene.ray_intersect(ray)
            if surface.is_valid():
                names[v, u] = pick(surface)
    return names


def ring(report, foton, theirs, scene, out):
    """Lines across the brightest caustics of the ring and of the glass on the table."""
    print("ring-glass", flush=True)
    prepared = sized(prepare(scene, foton.folder, RING_SIZE[0], 12), RING_SIZE)
    tree = xml.parse(prepared)
    tree.getroot().remove(tree.getroot().find("emitter[@type='constant']"))
    prepared = save(tree, prepared, "spot")

    def light_traced(seed):
        def image():
            loaded = mitsuba.load_file(str(prepared), integrator="ptracer")
            return np.array(mitsuba.render(loaded, seed=seed, spp=1024), dtype=np.float64)[..., :3]

        return theirs.cached(prepared, f"ptracer-1024spp-s{seed}", image)

    reference = np.stack([light_traced(seed) for seed in (1, 2, 3, 4)])
    ours = np.stack([foton.render(prepared, seed, 48, 1 << 19, 8, 0.004) for seed in range(1, 17)])
    with theirs.scalar_scene(prepared) as built:
        table = first_shapes(built, RING_SIZE, lambda s: s.bsdf().id()) == "wood"
    shown = [np.where(table[..., None], images.mean(axis=0), 0.0) for images in (ours, reference)]
    write_triptych(out / "shared-ring-glass.png", *shown)
    open_table = eroded(table, 3)
    grey = np.where(open_table, smooth(reference.mean(axis=(0, 3))), 0)
    for name in ("first", "second"):
        row, column = np.unravel_index(grey.argmax(), grey.shape)
        line_check(report, f"ring-glass: {name} caustic at {column},{row}", ours, reference, open_table, row, column)
        grey[max(row - 40, 0) : row + 40, max(column - 40, 0) : column + 40] = 0


def line_check(report, name, ours, reference, table, row, column):
    """Place and height of the peak along a row of pixels, a mean of three rows."""
    part = slice(max(column - 24, 0), column + 25)
    keep = table[row - 1 : row + 2, part].all(axis=0)

    def profile(image):
        line = image[row - 1 : row + 2, part].mean(axis=(0, 2))
        return np.where(keep, np.convolve(line, np.full(3, 1 / 3), mode="same"), 0)

    line, error = mean_and_error([profile(image) for image in ours])
    theirs, their_error = mean_and_error([profile(image) for image in reference])
    place, their_place = int(line.argmax()), int(theirs.argmax())
    noise = np.hypot(error[place] / line[place], their_error[their_place] / theirs[their_place])
    report.deviation(f"{name}: peak", line[place] / theirs[their_place] - 1, PEAK_BOUND, noise)
    own = f"reference σ {their_error[their_place] / theirs[their_place]:.2%}"
    shift = place - their_place
    report.add(f"{name}: place", f"{shift:+d} px", f"±{PLACE_BOUND} px", own, abs(shift) <= PLACE_BOUND)


def eroded(mask, pixels):
    """The mask without what lies within some pixels of its outside."""
    for _ in range(pixels):
        padded = np.pad(mask, 1)
        mask = mask & padded[2:, 1:-1] & padded[:-2, 1:-1] & padded[1:-1, 2:] & padded[1:-1, :-2]
    return mask


def smooth(grey):
    """The mean over 3×3 pixels."""
    padded = np.pad(grey, 1, mode="edge")
    return np.lib.stride_tricks.sliding_window_view(padded, (3, 3)).mean(axis=(2, 3))


def multiple_importance(report, foton, theirs, scene, out):
    """Means over each shape that does not emit."""
    print("veach-mis", flush=True)
    prepared = sized(prepare(scene, foton.folder, MIS_SIZE[0], 3), MIS_SIZE)
    reference = np.stack([theirs.render(prepared, seed, 512) for seed in (1, 2, 3, 4)])
    ours = np.stack([foton.render(prepared, seed, 24, 1 << 16, 32, direct="shadow-rays") for seed in (1, 2, 3, 4)])
    write_triptych(out / "shared-veach-mis.png", ours.mean(axis=0), reference.mean(axis=0))
    with theirs.scalar_scene(prepared) as built:
        shapes = first_shapes(built, MIS_SIZE, lambda s: "" if s.shape.is_emitter() else s.shape.id())
    for name in sorted(set(shapes.ravel()) - {""}):
        compare(report, f"veach-mis: {name}", ours, reference, eroded(shapes == name, 2))


def find_shared(repository):
    """Where the scenes of others are, if anywhere."""
    return Path(repository).resolve().parent / "shared" / "scenes"
