//! Linear images, tone mapping, PNG and EXR files with metadata.
