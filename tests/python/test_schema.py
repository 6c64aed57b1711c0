"""Scene files, their schema and their documentation agree."""

import json
import re

import jsonschema
import pytest
import sardf
from repository import ROOT, name_of

SCENES = sorted((ROOT / "scenes").glob("*.json")) + [ROOT / "tests/scenes/everything.json"]
EXAMPLES = re.findall(
    r"^```json\n(.*?)^```", (ROOT / "docs/scene_format.md").read_text(), re.MULTILINE | re.DOTALL
)
# What a schema can see without knowing names, formulas and geometry.
VISIBLE = [
    "unknown_key",
    "unknown_constructor",
    "unknown_parameter",
    "missing_parameter",
    "negative_radius",
    "radius_as_text",
    "two_numbers",
    "axis_name",
    "unknown_blend",
    "color",
    "roughness",
    "unknown_rule",
    "feature_with_both",
    "no_features",
    "no_materials",
    "many",
]


def without_comments(text: str) -> str:
    keep = r'("(?:[^"\\]|\\.)*")|//[^\n]*|/\*.*?\*/'
    return re.sub(keep, lambda match: match[1] or "", text, flags=re.DOTALL)


@pytest.fixture(scope="module")
def validator():
    schema = json.loads(sardf.schema())
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


@pytest.mark.parametrize("path", SCENES, ids=name_of)
def test_scenes_obey_the_schema(path, validator):
    assert not list(validator.iter_errors(json.loads(without_comments(path.read_text()))))


@pytest.mark.parametrize("name", VISIBLE)
def test_the_schema_sees_errors(name, validator):
    text = (ROOT / "tests/malformed" / f"{name}.json").read_text()
    assert not validator.is_valid(json.loads(without_comments(text)))


@pytest.mark.parametrize("text", EXAMPLES)
def test_examples_of_the_documentation_are_scenes(text, validator):
    assert not list(validator.iter_errors(json.loads(without_comments(text))))
    scene = sardf.Scene.from_json(text)
    assert scene.fractions([[0, 0, 0]]).sum() == pytest.approx(1, abs=1e-12)


def test_the_documentation_has_examples():
    assert len(EXAMPLES) >= 3
