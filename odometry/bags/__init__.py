"""Bags of ROS 1 and ROS 2 into run folders (extra `bags`)."""
