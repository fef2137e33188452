# SPDX-License-Identifier: Apache-2.0
"""A version that differs anywhere is named."""

import shutil
from pathlib import Path

import pytest
import versions


def test_all_places_state_one_version():
    assert versions.problems(versions.ROOT) == []


@pytest.mark.parametrize("place", range(1, len(versions.PLACES)))
def test_a_place_that_differs_is_named(place: int, tmp_path: Path):
    for file, _ in versions.PLACES:
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(versions.ROOT / file, tmp_path / file)
    file, pattern = versions.PLACES[place]
    path = tmp_path / file
    found = versions.re.search(pattern, path.read_text(), versions.re.MULTILINE)
    path.write_text(path.read_text().replace(found[0], found[0].replace("0", "7", 1)))
    assert len(versions.problems(tmp_path)) == 1
    assert versions.problems(tmp_path)[0].startswith(file)
