from tests.odometry.window_drives import inertial, stated, synthetic, winding

__all__ = ["inertial", "stated", "synthetic", "winding"]
