"""Which names are public: those of the modules that say so in `__all__`."""

import ast
import importlib
import pkgutil

import odometry
import terrain


def public_modules() -> dict[str, frozenset[str]]:
    """Public names by module: of both packages, and of the packages in them that list theirs."""
    names = {"odometry": odometry.__all__, "terrain": terrain.__all__}
    for package in (odometry, terrain):
        for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if found.ispkg:
                listed = getattr(importlib.import_module(found.name), "__all__", None)
                names |= {found.name: listed} if listed else {}
    return {module: frozenset(listed) for module, listed in names.items()}


PUBLIC = public_modules()


def private_imports(code: str) -> set[str]:
    """What a program imports of the packages that is not public."""
    found = set()
    for node in ast.walk(ast.parse(code)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names if alias.name not in PUBLIC}
        elif isinstance(node, ast.ImportFrom) and node.module is not None:
            listed = PUBLIC.get(node.module, frozenset())
            found |= {f"{node.module}.{alias.name}" for alias in node.names} - {
                f"{node.module}.{name}" for name in listed
            }
    return {name for name in found if name.split(".")[0] in ("odometry", "terrain")}
