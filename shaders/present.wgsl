// Shows linear images: exposure, tone map or false colour, zoom and pan, and a wipe between two of them.
//
// The same as foton_film::tone_map::display, to 1/255; a test compares them. Written for a target of gamma-encoded bytes.
// Not here: overlays (photons, discs, outlines), which the panels draw over it.

// What is seen only changes with a pass or a hand on it, the window around it far more often: `shade` draws into a texture when
// the view has changed, and `copy` brings that to the screen in every frame.

/// Of these a pipeline is made for each combination that is asked for: adapters in software run both sides of every branch
/// that is left in.
override MODE: u32;
override TONE_MAP: u32;
/// Whether there is a second image.
override COMPARES: bool;
/// Whether a pixel holds more than one texel of the first, of the second image. Not a branch on what `view` holds: some drivers
/// compile a shader anew for every value that alone decides a branch, and keep them all.
override SHRINKS_A: bool;
override SHRINKS_B: bool;
/// Whether pixels are marked that the tone map brings to the ends of a byte.
override MARKS_CLIPPING: bool;

/// Radiance through exposure and tone map, or the luminance as a position in the range, by value or by logarithm.
const RADIANCE: u32 = 0u;
const FALSE_COLOUR: u32 = 1u;
const FALSE_COLOUR_LOG: u32 = 2u;

const LINEAR: u32 = 0u;
const PBR_NEUTRAL: u32 = 1u;

/// As in foton_film::tone_map.
const BRIGHTEST: f32 = 65504.0;
const NOT_FINITE = vec3f(1.0, 0.0, 1.0);

/// Stripes over what is too bright in a channel, and what stands for black.
const CLIPPED = vec3f(1.0, 0.0, 0.0);
const BLACK = vec3f(0.0, 0.2, 0.8);
const STRIPE: u32 = 4u;

/// A pixel of the screen looks at no more texels than this along each axis.
const MAX_TAPS: f32 = 32.0;

struct View {
    /// Where the image lies, in pixels of the target.
    image_min: vec2f,
    image_size: vec2f,
    /// The size of each image in texels; a fraction where a reduced image ends within a texel.
    extent_a: vec2f,
    extent_b: vec2f,
    /// Encoded, around the image.
    background: vec3f,
    /// 2^stops.
    exposure: f32,
    /// The ends of the colour map: values, or their base-2 logarithms.
    low: f32,
    high: f32,
    /// Where the view lies, in pixels of the target.
    origin: vec2f,
    /// Where the first image ends and the second begins, as a part of the width of the view.
    wipe: f32,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var colour_map: texture_2d<f32>;
/// Red, green, blue, and 1 for a pixel that is finite, 0 for one that is not (its colour is then black).
@group(0) @binding(2) var image_a: texture_2d<f32>;
@group(0) @binding(3) var image_b: texture_2d<f32>;

struct Corner {
    @builtin(position) position: vec4f,
    /// From 0 at the left of the view to 1 at its right.
    @location(0) across: f32,
}

/// One triangle that covers the view.
@vertex
fn cover(@builtin(vertex_index) i: u32) -> Corner {
    let corner = vec2f(f32((i << 1u) & 2u), f32(i & 2u));
    return Corner(vec4f(corner * 2.0 - 1.0, 0.0, 1.0), corner.x);
}

@fragment
fn shade(corner: Corner) -> @location(0) vec4f {
    if COMPARES {
        return compare(corner);
    }
    return vec4f(seen(image_a, view.extent_a, SHRINKS_A, corner.position.xy), 1.0);
}

/// The first image left of the wipe's line and the second right of it.
fn compare(corner: Corner) -> vec4f {
    // The distance from the wipe's line in pixels.
    let from_wipe = (corner.across - view.wipe) / dpdx(corner.across);
    if abs(from_wipe) < 0.75 {
        return vec4f(1.0);
    }
    if abs(from_wipe) < 1.75 {
        return vec4f(0.0, 0.0, 0.0, 1.0);
    }
    if from_wipe < 0.0 {
        return vec4f(seen(image_a, view.extent_a, SHRINKS_A, corner.position.xy), 1.0);
    }
    return vec4f(seen(image_b, view.extent_b, SHRINKS_B, corner.position.xy), 1.0);
}

/// The encoded colour of an image at a pixel of the view.
fn seen(image: texture_2d<f32>, extent: vec2f, shrinks: bool, pixel: vec2f) -> vec3f {
    let uv = (pixel + view.origin - view.image_min) / view.image_size;
    if any(uv < vec2f(0.0)) || any(uv >= vec2f(1.0)) {
        return view.background;
    }
    let shown = colour(look_up(image, extent, shrinks, uv));
    if MARKS_CLIPPING && MODE == RADIANCE {
        return marked(shown, vec2u(pixel));
    }
    return shown;
}

/// A colour as it is, or what says that its bytes are at an end.
fn marked(shown: vec3f, pixel: vec2u) -> vec3f {
    if all(shown < vec3f(0.5 / 255.0)) {
        return BLACK;
    }
    let is_clipped = any(shown >= vec3f(254.5 / 255.0));
    let is_stripe = ((pixel.x + pixel.y) / STRIPE) % 2u == 0u;
    return select(shown, CLIPPED, is_clipped && is_stripe);
}

/// The mean over the pixel's box where the image shrinks, else the texel below `uv`.
fn look_up(image: texture_2d<f32>, extent: vec2f, shrinks: bool, uv: vec2f) -> vec4f {
    let last = textureDimensions(image) - 1u;
    let at = uv * extent;
    if !shrinks {
        return textureLoad(image, min(vec2u(at), last), 0);
    }
    let footprint = extent / view.image_size;
    let low = max(at - 0.5 * footprint, vec2f(0.0));
    let high = min(at + 0.5 * footprint, extent);
    let first = floor(low);
    let stride = max(ceil((high - first) / MAX_TAPS), vec2f(1.0));
    var sum = vec3f(0.0);
    var weights = 0.0;
    var all_finite = 1.0;
    for (var y = first.y; y < high.y; y += stride.y) {
        let in_y = min(y + 1.0, high.y) - max(y, low.y);
        for (var x = first.x; x < high.x; x += stride.x) {
            let weight = in_y * (min(x + 1.0, high.x) - max(x, low.x));
            let texel = textureLoad(image, min(vec2u(vec2f(x, y)), last), 0);
            sum += weight * limit(texel.rgb);
            weights += weight;
            all_finite = min(all_finite, texel.a);
        }
    }
    return vec4f(sum / weights, all_finite);
}

/// Keeps a sum of pixels finite: what is brighter than the brightest white counts as that. Measures are left alone.
fn limit(c: vec3f) -> vec3f {
    if MODE != RADIANCE {
        return c;
    }
    return clamp(c, vec3f(0.0), vec3f(BRIGHTEST / view.exposure));
}

/// The encoded colour that shows a pixel.
fn colour(found: vec4f) -> vec3f {
    if found.a < 0.5 {
        return NOT_FINITE;
    }
    if MODE == RADIANCE {
        return encode(tone_mapped(limit(found.rgb) * view.exposure));
    }
    var v = dot(found.rgb, vec3f(0.2126, 0.7152, 0.0722));
    if MODE == FALSE_COLOUR_LOG {
        v = log2(max(v, 1e-37));
    }
    let entries = textureDimensions(colour_map).x;
    let t = clamp((v - view.low) / (view.high - view.low), 0.0, 1.0);
    return textureLoad(colour_map, vec2u(u32(t * f32(entries - 1u) + 0.5), 0u), 0).rgb;
}

fn tone_mapped(c: vec3f) -> vec3f {
    switch TONE_MAP {
        case LINEAR: { return clamp(c, vec3f(0.0), vec3f(1.0)); }
        case PBR_NEUTRAL: { return pbr_neutral(c); }
        default: { return agx(c); }
    }
}

// The formulas stand in foton_film::tone_map.
fn pbr_neutral(exposed: vec3f) -> vec3f {
    let f90 = 0.04;
    let k_s = 0.8 - f90;
    let k_d = 0.15;
    let x = min(min(exposed.r, exposed.g), exposed.b);
    let f = select(f90, x - x * x / (4.0 * f90), x <= 2.0 * f90);
    let c = exposed - f;
    let p = max(max(c.r, c.g), c.b);
    if p <= k_s {
        return c;
    }
    let p_n = 1.0 - (1.0 - k_s) * (1.0 - k_s) / (p + 1.0 - 2.0 * k_s);
    let g = 1.0 / (k_d * (p - p_n) + 1.0);
    return c * (p_n / p * g) + p_n * (1.0 - g);
}

fn agx(c: vec3f) -> vec3f {
    let m = 0.2;
    let w = vec3f(0.2119946, 0.3921508, 0.3958546);
    let inset = c * (1.0 - m) + m * dot(w, c);
    let stops = clamp(log2(max(inset, vec3f(1e-10)) / 0.18), vec3f(-10.0), vec3f(6.5));
    let y = agx_curve((stops + 10.0) / 16.5);
    let outset = (y - m * dot(w, y)) / (1.0 - m);
    return pow(clamp(outset, vec3f(0.0), vec3f(1.0)), vec3f(2.2));
}

fn agx_curve(x: vec3f) -> vec3f {
    let d = x - 10.0 / 16.5;
    let p = select(vec3f(3.25), vec3f(3.0), d < vec3f(0.0));
    let k = select(vec3f(69.86279), vec3f(59.507875), d < vec3f(0.0));
    return 0.5 + 2.0 * d / pow(1.0 + k * pow(abs(d), p), 1.0 / p);
}

/// The transfer function of sRGB.
fn encode(c: vec3f) -> vec3f {
    return select(1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055, 12.92 * c, c <= vec3f(0.0031308));
}

/// What `shade` drew.
@group(0) @binding(4) var shaded: texture_2d<f32>;

@fragment
fn copy(corner: Corner) -> @location(0) vec4f {
    let last = textureDimensions(shaded) - 1u;
    return textureLoad(shaded, min(vec2u(corner.position.xy - view.origin), last), 0);
}
