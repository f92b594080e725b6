"""Which ffmpeg the package takes where the library has no encoder of its own."""
import os
import sys
import types

import pytest

from dreampm._video import find_ffmpeg


@pytest.fixture
def bare(monkeypatch, tmp_path):
    """A machine without ffmpeg and without imageio-ffmpeg."""
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("DREAMPM_FFMPEG", "")
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    return monkeypatch


def test_nothing_there_names_nothing(bare):
    find_ffmpeg()
    assert os.environ["DREAMPM_FFMPEG"] == ""


def test_the_one_of_pip(bare):
    bare.setitem(sys.modules, "imageio_ffmpeg", types.SimpleNamespace(get_ffmpeg_exe=lambda: "/of/pip"))
    find_ffmpeg()
    assert os.environ["DREAMPM_FFMPEG"] == "/of/pip"


def test_what_is_named_or_on_the_path_comes_first(bare, tmp_path):
    bare.setitem(sys.modules, "imageio_ffmpeg", types.SimpleNamespace(get_ffmpeg_exe=lambda: "/of/pip"))
    bare.setenv("DREAMPM_FFMPEG", "/named")
    find_ffmpeg()
    assert os.environ["DREAMPM_FFMPEG"] == "/named"
    bare.setenv("DREAMPM_FFMPEG", "")
    (tmp_path / "ffmpeg").touch(mode=0o755)
    find_ffmpeg()
    assert os.environ["DREAMPM_FFMPEG"] == ""
