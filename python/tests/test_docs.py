"""Docstrings of all public objects, their examples, and the names of the stubs."""

import doctest
import inspect
import pathlib

import pytest

import trundle
import trundle.evaluate
import trundle.gym
from trundle import _native


def documented():
    """Names of all public objects, with the objects."""
    for module in [trundle, trundle.evaluate, trundle.gym]:
        yield module.__name__, module
    for name in trundle.__all__:
        member = getattr(trundle, name)
        yield name, member
        if inspect.isclass(member):
            for part in vars(member):
                if not part.startswith("_"):
                    yield f"{name}.{part}", getattr(member, part)
    for name in trundle.evaluate.__all__:
        yield name, getattr(trundle.evaluate, name)


@pytest.mark.parametrize("name,member", list(documented()), ids=lambda value: value if isinstance(value, str) else "")
def test_docstrings_and_their_examples(name, member, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = inspect.getdoc(member)
    assert text, f"{name} has no docstring"
    test = doctest.DocTestParser().get_doctest(text, {"trundle": trundle}, name, None, 0)
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE)
    runner.run(test)
    assert runner.summarize(verbose=False).failed == 0


def test_every_class_shows_an_example():
    classes = [name for name in trundle.__all__ if inspect.isclass(getattr(trundle, name))]
    silent = [name for name in classes if ">>>" not in (inspect.getdoc(getattr(trundle, name)) or "")]
    assert not silent, silent


def test_the_stubs_are_part_of_the_package():
    folder = pathlib.Path(_native.__file__).parent
    assert (folder / "py.typed").exists() and (folder / "_native.pyi").exists()
