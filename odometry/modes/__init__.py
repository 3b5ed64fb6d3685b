"""Skid modes: which terrain, or which slipping wheels, the motion itself speaks for."""
