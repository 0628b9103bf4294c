//! Scene files and meshes to scene descriptions; the only reader of scene files.
