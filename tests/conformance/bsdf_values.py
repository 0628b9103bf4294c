"""Writes tests/golden/bsdf-values.txt: Mitsuba's BSDFs on a grid of directions. tests/tests/bsdf_values.rs compares ours with it.

Run it with any Python that has Mitsuba 3: `python tests/conformance/bsdf_values.py tests/golden/bsdf-values.txt`.

A block is a line with the BSDF's name, a line with its XML, and its values. Angles are in degrees, θ from the normal. A line
`value θo φo θi φi r g b pdf` is the BSDF's value (sr⁻¹, without the cosine) for light from i seen from o, and the density with
which i is sampled from o; delta lobes are not in it. The density of principled models is left at 0, since ours are sampled in
other proportions. A line `delta θo φo θi φi r g b chance` is such a lobe: the light it
brings from i to o, and the chance of choosing it.
"""

import math
import sys
from pathlib import Path

import mitsuba
import numpy as np

mitsuba.set_variant("scalar_rgb")

GOLD = '<string name="material" value="Au"/>'
GLASS = '<float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/>'
TINTED = '<rgb name="diffuse_reflectance" value="0.2, 0.5, 0.9"/><rgb name="specular_reflectance" value="0.9, 0.8, 0.7"/>'


def gloss(distribution, **alphas):
    """The properties of a distribution of facets."""
    text = "".join(f'<float name="{name}" value="{alpha}"/>' for name, alpha in alphas.items())
    return f'<string name="distribution" value="{distribution}"/>{text}'


def principled(**values):
    """The properties of a principled model."""
    colour = '<rgb name="base_color" value="0.8, 0.4, 0.1"/>'
    return colour + "".join(f'<float name="{name}" value="{value}"/>' for name, value in values.items())


BSDFS = {
    "diffuse": ("diffuse", '<rgb name="reflectance" value="0.2, 0.5, 0.8"/>'),
    "mirror": ("conductor", '<string name="material" value="none"/><rgb name="specular_reflectance" value="0.9, 0.6, 0.3"/>'),
    "gold": ("conductor", GOLD),
    "metal by indices": (
        "conductor",
        '<rgb name="eta" value="0.2, 0.92, 1.1"/><rgb name="k" value="3.9, 2.45, 2.14"/><rgb name="specular_reflectance" value="0.3"/>',
    ),
    "gold GGX 0.3": ("roughconductor", GOLD + gloss("ggx", alpha=0.3)),
    "gold Beckmann 0.2": ("roughconductor", GOLD + gloss("beckmann", alpha=0.2)),
    "copper GGX 0.15 0.5": ("roughconductor", '<string name="material" value="Cu"/>' + gloss("ggx", alpha_u=0.15, alpha_v=0.5)),
    "copper Beckmann 0.4 0.12": (
        "roughconductor",
        '<string name="material" value="Cu"/>' + gloss("beckmann", alpha_u=0.4, alpha_v=0.12),
    ),
    "glass": ("dielectric", GLASS),
    "thin glass": ("thindielectric", GLASS),
    "glass GGX 0.3": ("roughdielectric", GLASS + gloss("ggx", alpha=0.3)),
    "glass Beckmann 0.25": ("roughdielectric", GLASS + gloss("beckmann", alpha=0.25)),
    "glass GGX 0.2 0.5": ("roughdielectric", GLASS + gloss("ggx", alpha_u=0.2, alpha_v=0.5)),
    "plastic": ("plastic", TINTED),
    "plastic nonlinear": ("plastic", TINTED + '<boolean name="nonlinear" value="true"/>'),
    "plastic GGX 0.05": ("roughplastic", TINTED + gloss("ggx", alpha=0.05)),
    "plastic GGX 0.3": ("roughplastic", TINTED + gloss("ggx", alpha=0.3)),
    "plastic Beckmann 0.15": ("roughplastic", TINTED + gloss("beckmann", alpha=0.15)),
    "plastic Beckmann 0.6 nonlinear": (
        "roughplastic",
        TINTED + gloss("beckmann", alpha=0.6) + '<boolean name="nonlinear" value="true"/>',
    ),
    "principled": ("principled", principled()),
    "principled smooth, eta 1.8": ("principled", principled(roughness=0.25, eta=1.8)),
    "principled rough, specular 0.2": ("principled", principled(roughness=0.9, specular=0.2)),
    "principled metal": ("principled", principled(metallic=1.0, roughness=0.4, anisotropic=0.7)),
    "principled half metal, tinted": ("principled", principled(metallic=0.4, spec_tint=0.7, roughness=0.6)),
    "principled cloth": ("principled", principled(sheen=0.8, sheen_tint=0.6, flatness=0.7, roughness=0.8)),
    "principled varnish": ("principled", principled(clearcoat=0.8, clearcoat_gloss=0.7, roughness=0.7)),
    "principled glass": ("principled", principled(spec_trans=1.0, roughness=0.4)),
    "principled glass, stretched": ("principled", principled(spec_trans=1.0, roughness=0.6, anisotropic=0.5, eta=1.3)),
    "principled all": (
        "principled",
        principled(
            roughness=0.55,
            anisotropic=0.3,
            metallic=0.2,
            spec_trans=0.6,
            eta=1.6,
            spec_tint=0.4,
            sheen=0.5,
            sheen_tint=0.3,
            flatness=0.6,
            clearcoat=0.7,
            clearcoat_gloss=0.2,
        ),
    ),
    "thin principled": ("principledthin", principled()),
    "thin principled leaf": ("principledthin", principled(diff_trans=0.8, sheen=0.6, sheen_tint=0.5, flatness=0.4)),
    "thin principled paper": ("principledthin", principled(diff_trans=2.0)),
    "thin principled pane": ("principledthin", principled(spec_trans=1.0, roughness=0.6)),
    "thin principled pane, tinted": (
        "principledthin",
        principled(spec_trans=0.7, spec_tint=0.8, roughness=0.8, eta=1.8, anisotropic=0.6),
    ),
    "thin principled all": (
        "principledthin",
        principled(spec_trans=0.4, diff_trans=1.2, roughness=0.5, eta=1.3, spec_tint=0.3, sheen=0.5, flatness=0.5),
    ),
}

# Azimuths off the axes, so that no two differ by half a turn alone.
VIEWS = [(5, 20), (35, 110), (60, 250), (80, 340), (130, 70), (165, 200)]
LIGHTS = [(theta, phi) for theta, phi in zip((10, 25, 40, 55, 70, 85, 95, 120, 150, 170), range(0, 720, 73))]
AROUND = [(0, 0), (6, 0), (-9, 0), (0, 11), (4, -15)]


def direction(theta, phi):
    """The unit vector of two angles in degrees."""
    theta, phi = math.radians(theta), math.radians(phi)
    return mitsuba.ScalarVector3f(math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta))


def angles(v):
    """The two angles in degrees of a unit vector."""
    return math.degrees(math.atan2(math.hypot(v[0], v[1]), v[2])), math.degrees(math.atan2(v[1], v[0])) % 360


def lights_of(theta, phi):
    """Directions of light for a view: a grid, and some around the mirrored and the refracted one."""
    mirrored = [(theta + a, phi + 180 + b) for a, b in AROUND]
    here, beyond = (1, 1.5) if theta < 90 else (1.5, 1)
    sine = math.sin(math.radians(theta)) * here / beyond
    refracted = []
    if sine < 1:
        bent = math.degrees(math.asin(sine))
        refracted = [((180 - bent if theta < 90 else bent) + a, phi + 180 + b) for a, b in AROUND]
    return [(t, p % 360) for t, p in LIGHTS + mirrored + refracted if 0 < t < 180 and abs(t - 90) > 1]


def lines_of(plugin, properties):
    """All lines of one BSDF."""
    bsdf = mitsuba.load_string(f'<bsdf version="3.0.0" type="{plugin}">{properties}</bsdf>')
    context = mitsuba.BSDFContext()
    for theta, phi in VIEWS:
        surface = mitsuba.SurfaceInteraction3f()
        surface.wi = direction(theta, phi)
        surface.wavelengths = []
        for light in lights_of(theta, phi):
            wo = direction(*light)
            value, pdf = bsdf.eval_pdf(context, surface, wo)
            value = np.array(value) / abs(wo.z)
            if plugin.startswith("principled"):
                pdf = 0.0
            if pdf > 0 or value.any():
                yield line("value", (theta, phi), light, value, pdf)
        lobes = {}
        for u in np.linspace(0.0005, 0.9995, 200):
            sample, weight = bsdf.sample(context, surface, float(u), [0.37, 0.61])
            if mitsuba.has_flag(sample.sampled_type, mitsuba.BSDFFlags.Delta) and np.array(weight).any():
                lobes[sample.sampled_type] = line("delta", (theta, phi), angles(sample.wo), np.array(weight) * sample.pdf, sample.pdf)
        yield from lobes.values()


def line(kind, view, light, colour, density):
    """One line of the file."""
    return " ".join([kind, *(f"{x:.5g}" for x in (*view, *light, *colour, density))])


def main(path):
    """Writes the file."""
    text = [f"# Mitsuba {mitsuba.__version__}, made by tests/conformance/bsdf_values.py: see there for what the columns are."]
    for name, (plugin, properties) in BSDFS.items():
        text += [f"bsdf {name}", f'<bsdf type="{plugin}" id="it">{properties}</bsdf>', *lines_of(plugin, properties)]
    Path(path).write_text("\n".join(text) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1])
