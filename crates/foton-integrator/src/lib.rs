//! Progressive photon mapping: eye pass, photon passes, refinement.
