//! Autonomy for a two-wheeled indoor robot with one RGB-D camera.
