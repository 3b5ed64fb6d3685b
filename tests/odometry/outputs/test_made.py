from dataclasses import replace

from odometry.outputs.provenance import installed_packages


def test_the_identity_is_of_all_but_the_paths(made):
    moved = replace(made, command="terrain-odometry run /elsewhere/my_run")
    moved = replace(moved, inputs=tuple((r, f"/elsewhere/{p}", s) for r, p, s in made.inputs))
    assert moved.identity == made.identity
    others = [
        replace(made, verb="gap"),
        replace(made, settings={"vision": [False]}),
        replace(made, inputs=made.inputs[:1]),
        replace(made, inputs=(("RUN", "my_run", "ab13"), made.inputs[1])),
        replace(made, packages={"numpy": "2.5"}),
    ]
    assert len({made.identity, *(other.identity for other in others)}) == 1 + len(others)


def test_the_comment_is_comment_lines_whatever_the_paths(made):
    odd = replace(made, command="terrain-odometry run 'a\nb\x00\x7f ä'")
    lines = odd.to_comment().splitlines()
    assert all(line.startswith("# ") for line in lines)
    assert lines[1] == "# command: terrain-odometry run 'a\\nb\\x00\\x7f ä'"
    assert lines[0] == "# made by: terrain-odometry run"
    assert "# --parameters set.toml: sha256 cd34" in lines


def test_packages_are_named_with_their_versions():
    packages = installed_packages()
    assert {"terrain-odometry", "numpy", "scipy", "scikit-learn", "scikit-image"} <= set(packages)
    assert any(name.startswith("opencv") for name in packages)
