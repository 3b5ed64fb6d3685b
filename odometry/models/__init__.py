"""Kinematic models: from tread speeds to body twist."""
