"""The same scene with its booleans joined by other blends."""

import sardf
from sardf import _core
from sardf.plot.names import choose, fail
from sardf.plot.numbers import number

OWN = "scene"


def blend_from(text: str):
    """A Blend from "min_max", "r_function", "sardf=0.5", ...; Error for anything else."""
    name, equals, value = (part.strip() for part in text.partition("="))
    make = getattr(_core, choose("blend", name, {**_core._blends, OWN: OWN}))
    _, parameters = _core._signatures[make.__name__]
    if len(parameters) != (1 if equals else 0):
        wanted = f"{name}=NUMBER" if parameters else name
        fail(f"the blend is '{text}'; '{wanted}' is accepted")
    return make(number(value, f"blend's {parameters[0][0]}")) if equals else make()


def blend_name(blend) -> str:
    """A blend in the words of the command line: sardf=0.5."""
    return "=".join([blend.name, *(f"{value:g}" for value in blend.parameters)])


def variants(scene, blends) -> list[tuple[str, object]]:
    """(title, scene) for each blend: text as for blend_from, a Blend, or "scene" for the scene as
    it is. Without blends the scene alone, without a title."""
    made = []
    for blend in blends:
        if blend == OWN:
            made.append(("as in the scene", scene))
        else:
            blend = blend if isinstance(blend, sardf.Blend) else blend_from(blend)
            made.append((blend_name(blend), scene.with_blend(blend)))
    return made or [("", scene)]
