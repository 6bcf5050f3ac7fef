//! Data sets, maps, trajectories and recordings on disk.
