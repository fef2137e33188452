"""YAML files that people write: `off` stays a word, and mistakes name the file and the line."""

import re
from pathlib import Path

import yaml

from levelwind.errors import ToolError


class _Loader(yaml.SafeLoader):
    """Only true and false are booleans: YAML 1.1 would turn the mode `off` into false."""


_BOOL = "tag:yaml.org,2002:bool"
_Loader.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers if tag != _BOOL]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
_Loader.add_implicit_resolver(_BOOL, re.compile("^(?:true|false)$"), list("tf"))


def load(path: Path) -> object:
    """The document in a YAML file."""
    try:
        with path.open(encoding="utf-8") as file:
            return yaml.load(file, _Loader)
    except OSError as error:
        raise ToolError(f"{path}: {error.strerror}.") from error
    except UnicodeDecodeError as error:
        raise ToolError(f"{path} is no text file.") from error
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f":{mark.line + 1}" if mark else ""
        raise ToolError(f"{path}{place}: {getattr(error, 'problem', error)}.") from error
