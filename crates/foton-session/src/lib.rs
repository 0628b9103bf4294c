//! Runs the integrator: stop rules, stage clocks, snapshots on the way.
