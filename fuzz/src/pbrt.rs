//! Scenes of pbrt: what mutation starts from, and files that they name.

/// One of everything that a file of version 4 may say.
const NEW: &str = "Option \"integer seed\" 1 ColorSpace \"rec2020\"
LookAt 0 0 -5  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 40 \"float screenwindow\" [ -1 1 -1 1 ] \"float lensradius\" 0.1
Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4 \"float cropwindow\" [0 .5 0 1] PixelFilter \"gaussian\"
Integrator \"volpath\" \"integer maxdepth\" 4 WorldBegin Attribute \"shape\" \"float alpha\" 0.5
AttributeBegin Rotate 90 1 0 0 Scale 1 2 1 ReverseOrientation
AreaLightSource \"diffuse\" \"blackbody L\" 3000 \"float power\" 10 \"bool twosided\" true
Shape \"disk\" \"float radius\" 2 \"float innerradius\" .5 AttributeEnd
Texture \"i\" \"spectrum\" \"imagemap\" \"string filename\" \"red.png\" \"bool invert\" true \"string encoding\" \"gamma 2\"
Texture \"c\" \"spectrum\" \"checkerboard\" \"texture tex1\" \"i\" \"rgb tex2\" [ .1 .2 .3 ] \"float uscale\" 3
Texture \"s\" \"float\" \"scale\" \"texture tex\" \"c\" \"float scale\" 2 Texture \"m\" \"spectrum\" \"mix\" \"texture amount\" \"c\"
MakeNamedMaterial \"a\" \"string type\" \"coatedconductor\" \"texture conductor.roughness\" \"s\" \"rgb reflectance\" [.5 .5 .5]
MakeNamedMaterial \"b\" \"string type\" \"diffusetransmission\" \"texture reflectance\" \"m\" \"texture displacement\" \"c\"
MakeNamedMaterial \"c\" \"string type\" \"mix\" \"string materials\" [ \"a\" \"b\" ] \"float amount\" .25
ObjectBegin \"o\" NamedMaterial \"c\" Shape \"sphere\" \"float zmax\" .5
Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0] \"normal N\" [0 0 1 0 0 1 0 0 1 0 0 1]
Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1] Shape \"loopsubdiv\" \"integer levels\" 2 \"point3 P\" [0 0 0 1 0 0 0 1 0]
ObjectEnd Translate 1 2 3 ObjectInstance \"o\" TransformBegin Transform [1 0 0 0 0 1 0 0 0 0 1 0 1 2 3 1] ObjectInstance \"o\" TransformEnd
Material \"conductor\" \"spectrum eta\" \"metal-Cu-eta\" \"spectrum k\" [400 1 700 2] \"float uroughness\" .2
Shape \"plymesh\" \"string filename\" \"m.ply\" Material \"dielectric\" \"spectrum eta\" \"glass-BK7\" Shape \"cylinder\"
MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" MediumInterface \"fog\" \"\" Material \"interface\" Shape \"sphere\"
LightSource \"infinite\" \"string filename\" \"square.hdr\" LightSource \"distant\" \"point3 from\" [1 2 3] \"float illuminance\" 3
Include \"part.pbrt\" Import \"part.pbrt\" Include \"f.pbrt\"
";

/// The same of version 3.
const OLD: &str = "Scale -1 1 1 Transform [1 0 0 0  0 1 0 0  0 0 1 0  0 0 5 1]
Camera \"perspective\" \"float fov\" [45] Film \"image\" \"integer xresolution\" [4] \"integer yresolution\" [4] # a comment
PixelFilter \"mitchell\" Sampler \"halton\" Integrator \"sppm\" \"integer photonsperiteration\" 100 \"float radius\" .1
WorldBegin TransformTimes 0 1 ActiveTransform EndTime Translate 1 0 0 ActiveTransform All
CoordinateSystem \"here\" CoordSysTransform \"here\"
Texture \"t\" \"float\" \"bilerp\" \"float v00\" 1 Texture \"u\" \"color\" \"fbm\" Texture \"w\" \"spectrum\" \"constant\" \"rgb value\" [1 0 0]
Material \"plastic\" \"texture Kd\" \"w\" \"color Ks\" [.2 .2 .2] \"texture roughness\" \"t\" Shape \"sphere\" \"float phimax\" 90
Material \"uber\" \"rgb Kt\" [.1 .1 .1] \"rgb Kr\" [.1 .1 .1] \"rgb opacity\" [.5 .5 .5] \"texture bumpmap\" \"t\" Shape \"cone\"
Material \"translucent\" Shape \"paraboloid\" Material \"substrate\" Shape \"hyperboloid\" Material \"glass\" \"float uroughness\" .1
Shape \"heightfield\" \"integer nu\" 2 \"integer nv\" 2 \"float Pz\" [0 1 2 3] Material \"metal\" Shape \"disk\"
Material \"disney\" \"bool thin\" \"true\" \"float sheen\" 1 Shape \"sphere\" Material \"hair\" Shape \"sphere\"
Material \"kdsubsurface\" Shape \"sphere\" Material \"matte\" \"float sigma\" 20 Shape \"sphere\" Material \"mirror\" Shape \"sphere\"
LightSource \"spot\" \"blackbody I\" [3000 2] \"point to\" [0 1 0] LightSource \"point\" \"xyz I\" [1 1 1]
LightSource \"goniometric\" \"string mapname\" \"red.png\" LightSource \"projection\" \"string mapname\" \"red.png\"
LightSource \"infinite\" \"string mapname\" \"red.png\" \"rgb scale\" [1 2 3]
AreaLightSource \"diffuse\" \"spectrum L\" \"Cu.eta.spd\" Shape \"curve\" WorldEnd
";

/// A triangle.
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
    element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// A picture of one pixel in Radiance's format.
const SQUARE: &[u8] = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x40\x20\x81";

/// What mutation starts from.
pub(crate) fn seeds() -> Vec<Vec<u8>> {
    vec![NEW.into(), OLD.into()]
}

/// A file beside a scene, which it may name.
pub(crate) fn file(name: &str) -> Option<Vec<u8>> {
    match name {
        "part.pbrt" => Some(b"Translate 1 0 0 Shape \"sphere\"".to_vec()),
        "m.ply" => Some(PLY.into()),
        "square.hdr" => Some(SQUARE.into()),
        _ => None,
    }
}
