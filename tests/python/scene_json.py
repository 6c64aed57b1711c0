"""Scene files as plain data, by a reader of their comments that shares no code with the product."""

import json


def load_document(path):
    text, result, position = path.read_text(encoding="utf-8"), [], 0
    while position < len(text):
        rest = text[position:]
        if rest.startswith("//"):
            position += len(rest.split("\n", 1)[0])
        elif rest.startswith("/*"):
            position += rest.index("*/") + 2
        elif rest.startswith('"'):
            value, end = json.JSONDecoder().raw_decode(rest)
            result.append(json.dumps(value))
            position += end
        else:
            result.append(rest[0])
            position += 1
    return json.loads("".join(result))
