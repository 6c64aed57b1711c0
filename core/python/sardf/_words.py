"""What a user may type, read in one place: names, numbers, blends; and what attributes are."""

import difflib
import math

from sardf import _core

LONGEST_LIST = 40
OWN = "scene"


def fail(message: str):
    """Raises Error with the message, for input that is wrong."""
    _core._fail(message)


def choose(kind: str, name: str, accepted):
    """accepted[name], or `name` itself where `accepted` is a list; Error that names the nearest."""
    if name in accepted:
        return accepted[name] if isinstance(accepted, dict) else name
    if not accepted:
        fail(f"there is no {kind} '{name}': the scene has none")
    near = difflib.get_close_matches(name, list(accepted), n=1, cutoff=0.5)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    listed = f"accepted are {', '.join(accepted)}"
    if len(accepted) > LONGEST_LIST:
        listed = f"{len(accepted)} names are accepted, such as {', '.join(list(accepted)[:5])}"
    return fail(f"there is no {kind} '{name}'; {listed}{hint}")


def number(text, what: str) -> float:
    """A finite number; Error otherwise."""
    try:
        value = float(text)
    except (TypeError, ValueError):
        value = math.nan
    if not math.isfinite(value):
        fail(f"the {what} is '{text}'; a finite number is accepted")
    return value


def blend_from(text: str):
    """A Blend from "min_max", "r_function", "sardf=0.5", ...; Error for anything else."""
    name, equals, value = (part.strip() for part in text.partition("="))
    make = getattr(_core, choose("blend", name, _core._blends))
    _, parameters = _core._signatures[make.__name__]
    if len(parameters) != (1 if equals else 0):
        wanted = f"{name}=NUMBER" if parameters else name
        fail(f"the blend is '{text}'; '{wanted}' is accepted")
    return make(number(value, f"blend's {parameters[0][0]}")) if equals else make()


def blend_name(blend) -> str:
    """A blend in the words of the command line: sardf=0.5."""
    return "=".join([blend.name, *(f"{value:g}" for value in blend.parameters)])


def variants(scene, blends) -> list[tuple[str, object]]:
    """The same scene with its booleans joined by other blends: (title, scene) for each.

    A blend is text as for blend_from, a Blend, or "scene" for the scene as it is. Without blends
    the scene alone, without a title.
    """
    made = []
    for blend in blends:
        if blend == OWN:
            made.append(("as in the scene", scene))
        else:
            blend = blend if isinstance(blend, _core.Blend) else blend_from(blend)
            made.append((blend_name(blend), scene.with_blend(blend)))
    return made or [("", scene)]


def components_of(evaluate) -> list[str] | int:
    """The components that an attribute, one of scene.attributes, gives at a point: their names
    where they have some, else how many there are."""
    values = evaluate([(0.0, 0.0, 0.0)])
    if isinstance(values, dict):
        return list(values)
    return 1 if values.ndim == 1 else values.shape[1]


def vector_attribute(scene, name: str, counts: tuple[int, ...], use: str):
    """The attribute of that name, points (N, 3) -> (N, components), as one of `counts` components.

    Raises Error where there is none or where it is something else; `use` says there what takes a
    vector: "arrows show".
    """
    evaluate = choose("attribute", name, scene.attributes)
    components = components_of(evaluate)
    if components in counts:
        return evaluate
    found = "a number" if components == 1 else f"a vector of {components} components"
    if isinstance(components, list):
        found = f"made of the components {', '.join(components)}"
    accepted = " or ".join(str(count) for count in counts)
    return fail(f"the attribute '{name}' is {found}; {use} a vector of {accepted} components")
