"""Naming terrain: patches, features, nearest neighbours, rejection, model files."""
