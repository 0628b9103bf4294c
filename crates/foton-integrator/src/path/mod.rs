//! Path tracing: paths from the camera alone, which look for emitters at every surface and also meet them by chance. `[VEA97]`

mod tracer;

pub(crate) use tracer::PathTracer;
