import pytest

import dreampm as dm
from conftest import SOURCE


def test_make_goes_the_whole_way_and_knows_what_is_done(tmp_path, caplog):
    scene = dict(variant="tiny", set={"time.frames": 2, "render.size": [64, 48], "render.samples": 4},
                 out=str(tmp_path / "film"))
    with caplog.at_level("INFO", "dreampm"):
        film = dm.make(SOURCE / "scenes/dam-break.yaml", **scene)
    assert film == tmp_path / "film/dam-break.mp4" and film.stat().st_size > 500
    assert any("frame" in record.message for record in caplog.records)
    when = film.stat().st_mtime_ns
    assert dm.make(SOURCE / "scenes/dam-break.yaml", **scene).stat().st_mtime_ns == when


def test_make_refuses_as_the_command_does(tmp_path):
    with pytest.raises(dm.InputError, match="no-such.yaml"):
        dm.make(tmp_path / "no-such.yaml")


def test_validate(tmp_path):
    [case] = dm.validate("still-column", out=tmp_path)
    assert case["name"] == "still-column" and isinstance(case["pass"], bool) and case["metrics"]
    assert list(tmp_path.glob("still-column*.svg"))
    with pytest.raises(dm.InputError, match="still-column"):
        dm.validate("still-colum")
    with pytest.raises(TypeError):
        dm.validate()
