from tests.terrain.cli.identify_calls import command

__all__ = ["command"]
