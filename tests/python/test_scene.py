import pickle
import re
import threading

import numpy as np
import pytest

import dreampm as dm
from conftest import SOURCE

SPACE = {"min": [0, 0, 0], "max": [1, 1, 1], "spacing": 0.05}
WATER = {"water": {"type": "newtonian"}}
DROP = {"drop": {"material": "water", "shape": {"sphere": {"radius": 0.2}, "center": [0.5, 0.5, 0.5]}}}


def test_a_file_a_variant_and_values_over_it(dam):
    assert (dam.name, dam.frame_count, dam.material_names) == ("dam-break", 12, ["water"])
    assert dam.spacing == pytest.approx(0.033333)
    finer = dm.Scene.load(SOURCE / "scenes/dam-break.yaml", variant="tiny",
                          set={"space.spacing": 0.02, "time.frames": 3})
    assert (finer.spacing, finer.frame_count) == (0.02, 3)
    assert finer.with_(["time.frames=5"]).frame_count == 5


def test_sections_text_and_dict_say_the_same():
    sections = dm.Scene(space=SPACE, materials=WATER, bodies=DROP)
    assert dm.Scene({"space": SPACE, "materials": WATER, "bodies": DROP}).yaml() == sections.yaml()
    assert dm.Scene(sections.yaml()).yaml() == sections.yaml()


def test_values_of_numpy_have_a_place():
    scene = dm.Scene(space={"min": np.zeros(3), "max": np.float32([1, 1, 2]), "spacing": np.float64(0.05)},
                     materials=WATER, bodies=DROP, gravity=(0, -1, 0))
    assert scene.max == (1, 1, 2) and dm.Simulation(scene).gravity == (0, -1, 0)
    with pytest.raises(TypeError, match="a set has no place in a scene"):
        dm.Scene(space={1, 2}, materials=WATER, bodies=DROP)


def test_every_error_has_its_line_and_column(tmp_path):
    file = tmp_path / "drop.yaml"
    file.write_text(dm.Scene(space=SPACE, materials=WATER, bodies=DROP).yaml().replace("spacing:", "spcing:"))
    with pytest.raises(dm.InputError) as refused:
        dm.Scene.load(file)
    lines = str(refused.value).splitlines()
    assert all(re.match(re.escape(str(file)) + r":\d+:\d+: error: ", line) for line in lines), lines
    assert any("did you mean 'spacing'?" in line for line in lines)
    assert isinstance(refused.value, ValueError) and isinstance(refused.value, dm.Error)


def test_an_error_of_a_section_names_its_line():
    unknown = r"^scene:3:\d+: error: unknown key 'space.spcing'; did you mean 'spacing'\?"
    with pytest.raises(dm.InputError, match=unknown):
        dm.Scene(space={**SPACE, "spcing": 1}, materials=WATER, bodies=DROP)
    with pytest.raises(dm.InputError, match="small.*preview"):
        dm.Scene.load(SOURCE / "scenes/dam-break.yaml", variant="small")
    with pytest.raises(TypeError, match="one of them"):
        dm.Scene()


def test_warnings_go_to_logging(caplog):
    text = dm.Scene(space=SPACE, materials=WATER, bodies=DROP).yaml()
    with caplog.at_level("INFO", "dreampm"):
        dm.Simulation(dm.Scene(text))
    assert all(record.name == "dreampm" for record in caplog.records)


def test_a_scene_can_be_pickled_and_shared(dam):
    assert pickle.loads(pickle.dumps(dam)).yaml() == dam.yaml()
    names = []
    threads = [threading.Thread(target=lambda: names.append(dam.name)) for _ in range(4)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    assert names == ["dam-break"] * 4
