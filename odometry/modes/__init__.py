"""Skid modes: which ground, or which slipping wheels, the motion itself speaks for."""
