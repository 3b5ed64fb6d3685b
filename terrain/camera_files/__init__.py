"""Calibration files of other programs: ROS camera_info, Kalibr, OpenCV, frame transforms."""
