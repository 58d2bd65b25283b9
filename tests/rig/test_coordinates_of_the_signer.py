from __future__ import annotations

import numpy as np

from azee_rig.rig import Rig

AXES = {
    "back": ("flexion", "lateral", "axial"),
    "neck": ("axial", "flexion", "lateral"),
    "head": ("axial", "flexion", "lateral"),
    "clav": ("elevation", "protraction"),
    "arm": ("flexion", "abduction", "rotation"),
    "f_arm": ("flexion", "pronation"),
    "palm": ("flexion", "deviation"),
    "eye": ("yaw", "pitch"),
}


def test_bind_and_idle_lie_inside_the_limits(signer: Rig) -> None:
    c = signer.coordinates
    for q in (c.bind, c.idle):
        outside = [
            n
            for n, v, low, high in zip(c.names, q, c.lower, c.upper, strict=True)
            if not low <= v <= high
        ]
        assert outside == []


def test_there_is_one_coordinate_per_anatomical_degree_of_freedom(signer: Rig) -> None:
    expected = set()
    for bone in signer.bones:
        base = bone.split("_")[0] if bone.startswith("back") else bone.rstrip("LR").rstrip("_")
        if base in AXES:
            expected |= {f"{bone}.{turn}" for turn in AXES[base]}
        else:
            expected.add(f"{bone}.flexion")
            if bone.endswith("1"):
                thumb = bone.startswith("thumb")
                expected |= {
                    f"{bone}.{t}" for t in (("abduction", "roll") if thumb else ("deviation",))
                }
    assert set(signer.coordinates.names) == expected
    assert len(signer.coordinates) == 76


def test_both_sides_have_the_same_limits(signer: Rig) -> None:
    c = signer.coordinates
    assert sum("_L" in name for name in c.index) == sum("_R" in name for name in c.index) > 25
    for name, i in c.index.items():
        if "_L" in name:
            j = c.index[name.replace("_L", "_R")]
            for values in (c.lower, c.upper, c.idle, c.bind, c.stiffness):
                assert abs(values[i] - values[j]) < 1e-9, name


def test_some_limits_are_the_published_ones(signer: Rig) -> None:
    c = signer.coordinates
    for name, low, high in (
        ("f_arm_R.flexion", 0, 145),
        ("f_arm_R.pronation", -90, 85),
        ("palm_L.flexion", -70, 75),
        ("index_R_1.flexion", -45, 90),
        ("middle_L_2.flexion", 0, 100),
        ("little_R_3.flexion", -5, 80),
        ("head.axial", -40, 40),
        ("eye_L.pitch", -25, 25),
    ):
        limits = np.degrees([c.lower[c.index[name]], c.upper[c.index[name]]])
        np.testing.assert_allclose(limits, (low, high), atol=1e-6)


def test_stiffness_weighs_the_trunk_most(signer: Rig) -> None:
    c = signer.coordinates
    found = {
        n: float(c.stiffness[c.index[n]])
        for n in ("back_1.axial", "clav_L.elevation", "palm_R.flexion", "arm_L.flexion")
    }
    assert found == {
        "back_1.axial": 6,
        "clav_L.elevation": 3,
        "palm_R.flexion": 1.5,
        "arm_L.flexion": 1,
    }
