"""Validates manifests against docs/manifest.schema.json.

usage: validate_manifest.py SCHEMA MANIFEST...
       validate_manifest.py --serve SCHEMA

The schema leaves room for keys of later versions; here it is closed, so that a key that it does not know is an
error. Ends with 1 and a line for each error, and with 77 where there is no python3-jsonschema. --serve says `ready`, and
then for each line of its input, the path of a manifest, the lines of its errors and an empty one.
"""
import json
import sys

try:
    import jsonschema
except ImportError:
    print("python3-jsonschema is not installed")
    sys.exit(77)


def closed(schema):
    """The schema with no room for keys that it does not name."""
    if isinstance(schema, list):
        return [closed(one) for one in schema]
    if not isinstance(schema, dict):
        return schema
    out = {key: closed(value) for key, value in schema.items()}
    if out.get("type") == "object" and "properties" in out:
        out.setdefault("additionalProperties", False)
    return out


def errors(validator, path):
    """A line for each error of a file."""
    with open(path, encoding="utf-8") as file:
        manifest = json.load(file)
    for error in validator.iter_errors(manifest):
        place = "/".join(str(part) for part in error.absolute_path)
        yield f"{path}: /{place}: {error.message[:300]}".replace("\n", " ")


def serve(validator):
    print("ready", flush=True)
    for line in sys.stdin:
        try:
            for error in errors(validator, line.rstrip("\n")):
                print(error)
        except (OSError, ValueError) as error:
            print(f"{line.rstrip()}: {error}")
        print(flush=True)
    return 0


def main(schema_path, manifests):
    serving = schema_path == "--serve"
    with open(manifests[0] if serving else schema_path, encoding="utf-8") as file:
        schema = json.load(file)
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(closed(schema))
    if serving:
        return serve(validator)
    status = 0
    for path in manifests:
        for error in errors(validator, path):
            print(error)
            status = 1
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
