"""One mission laid upon another of the same campaign."""

from __future__ import annotations

from pathlib import Path

import pytest

from inspect_cli.errors import SchemaError
from inspect_cli.schema.loading import load_mission
from inspect_cli.schema.specimens import AnalyticSpecimen


def refusal(file: Path) -> str:
    with pytest.raises(SchemaError) as caught:
        load_mission(file)
    return str(caught.value).replace(f"{file.parent}/", "")


def write(campaign: Path, name: str, text: str) -> Path:
    file = campaign / "missions" / name
    file.parent.mkdir(exist_ok=True)
    file.write_text(text)
    return file


def test_mappings_merge_sequences_are_replaced_and_null_removes(campaign: Path) -> None:
    file = write(
        campaign,
        "variant.yaml",
        "extends: m.yaml\n"
        "name: variant\n"
        "seeds: [7]\n"
        "truth: {structure: {wall: {friction: 0.9, specimen: ~}}, platform: {mass_factor: 1.1}}\n",
    )
    base, variant = load_mission(campaign / "missions" / "m.yaml"), load_mission(file)
    assert variant.mission.name == "variant"
    assert variant.mission.seeds == (7,)
    assert variant.mission.tasks == base.mission.tasks
    assert variant.truth.structure["wall"].friction == 0.9
    assert variant.truth.structure["wall"].specimen is None
    assert variant.truth.platform.mass_factor == 1.1


def test_a_specimen_of_another_model_replaces_the_inherited_one(campaign: Path) -> None:
    file = write(
        campaign,
        "variant.yaml",
        "extends: m.yaml\n"
        "name: variant\n"
        "truth: {structure: {wall: {specimen: {model: analytic, potential_v: -0.3}}}}\n",
    )
    specimen = load_mission(file).truth.structure["wall"].specimen
    assert specimen == AnalyticSpecimen(model="analytic", potential_v=-0.3)
    assert load_mission(file).truth.structure["wall"].friction == 0.4


def test_an_inherited_path_leads_to_the_same_file(campaign: Path) -> None:
    file = write(campaign, "deep/variant.yaml", "extends: ../m.yaml\nname: variant\n")
    loaded = load_mission(file)
    assert loaded.mission.structure[1].surface.cloud == "missions/scans/tank.ply"


def test_a_problem_is_reported_in_the_file_that_has_it(campaign: Path) -> None:
    base = campaign / "missions" / "m.yaml"
    base.write_text(base.read_text().replace("rows: 1", "rows: 0"))
    file = write(campaign, "variant.yaml", "extends: m.yaml\nname: variant\nseeds: [-1]\n")
    assert refusal(file).splitlines() == [
        "m.yaml:16:13: tasks[0].contact_grid.rows: must be at least 1; found 0",
        "variant.yaml:3:9: seeds[0]: must be at least 0; found -1",
    ]


def test_a_variant_needs_a_name_of_its_own(campaign: Path) -> None:
    file = write(campaign, "variant.yaml", "extends: m.yaml\n")
    assert refusal(file) == "variant.yaml:1:1: missing key 'name'"


@pytest.mark.parametrize(
    ("target", "message"),
    [
        ("n.yaml", "variant.yaml:1:10: extends: no such file: n.yaml"),
        ("../../m.yaml", "variant.yaml:1:10: extends: leads out of the campaign folder"),
        ("variant.yaml", "variant.yaml:1:10: extends: files extend each other in a circle"),
        ("[m.yaml]", "variant.yaml:1:10: extends: must be text; found a list"),
    ],
)
def test_what_cannot_be_extended(campaign: Path, target: str, message: str) -> None:
    file = write(campaign, "variant.yaml", f"extends: {target}\nname: variant\n")
    assert message in refusal(file)


def test_a_circle_over_several_files_is_refused(campaign: Path) -> None:
    write(campaign, "a.yaml", "extends: b.yaml\nname: a\n")
    file = write(campaign, "b.yaml", "extends: a.yaml\nname: b\n")
    assert "a.yaml:1:10: extends: files extend each other in a circle" in refusal(file)


def test_a_long_chain_is_refused(campaign: Path) -> None:
    for i in range(1, 8):
        base = "m.yaml" if i == 1 else f"v{i - 1}.yaml"
        file = write(campaign, f"v{i}.yaml", f"extends: {base}\nname: v{i}\n")
    assert load_mission(campaign / "missions" / "v5.yaml").mission.name == "v5"
    assert "extends more than 5 deep" in refusal(file)
