"""Hints for what a user may not have meant."""

from types import SimpleNamespace

from terrain.cli.hints import hints


def result(initial="gravel", tables=("gravel",), classes=None, images=True):
    watcher = (
        None if classes is None else SimpleNamespace(classifier=SimpleNamespace(classes_=classes))
    )
    return SimpleNamespace(
        initial_terrain=initial,
        parameters=SimpleNamespace(terrains=dict.fromkeys(tables)),
        watcher=watcher,
        run=SimpleNamespace(images=images or None),
    )


def test_nothing_to_say():
    assert hints(result(classes=["gravel"]), vision=True) == []
    assert hints(result(), vision=False) == []
    assert hints(result(initial="ground", tables=(), images=False), vision=True) == []


def test_a_terrain_without_a_table_is_named():
    (hint,) = hints(result(initial="gravle", images=False), vision=True)
    assert "'gravle' has no table" in hint
    assert "gravel" in hint
    (hint,) = hints(result(classes=["gravel", "ice"]), vision=True)
    assert "'ice'" in hint


def test_images_without_a_model_are_named():
    (hint,) = hints(result(), vision=True)
    assert "--model" in hint
