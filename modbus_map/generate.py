#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Generate everything that is made from the Modbus map, modbus_map/registers.yaml.

python3 modbus_map/generate.py           write the files
python3 modbus_map/generate.py --check   exit 1 if a file is not what would be written
"""

import argparse
import sys
from pathlib import Path

import emit_client
import emit_core
import emit_documents
import emit_fuxa
import emit_integrations
import emit_pictures
import emit_plc
import emit_python
from map_model import MapError, load

ROOT = Path(__file__).resolve().parent.parent
OUTPUTS = {
    "lib/lw_core/generated/lw/map.h": emit_core.map_h,
    "lib/lw_core/generated/map.c": emit_core.map_c,
    "host_tools/python/src/levelwind/map_table.py": emit_python.map_table,
    "host_tools/c/generated/levelwind_map.h": emit_client.map_h,
    "host_tools/c/generated/levelwind_map.c": emit_client.map_c,
    "doc/registers.md": emit_documents.registers_md,
    "doc/states.svg": emit_pictures.states_svg,
    "doc/parameter_change.svg": emit_pictures.handshake_svg,
    "modbus_map/tags.csv": emit_documents.tags_csv,
    "modbus_map/tags.json": emit_integrations.map_json,
    "modbus_map/tags_node_red.json": emit_integrations.node_red_json,
    "modbus_map/tags_home_assistant.yaml": emit_integrations.home_assistant_yaml,
    "modbus_map/tags_fuxa.json": emit_fuxa.fuxa_json,
    "modbus_map/tags_telegraf.conf": emit_integrations.telegraf_conf,
    "modbus_map/tags_wot_td.json": emit_integrations.wot_td_json,
    "modbus_map/tags_iec61131.st": emit_plc.structured_text,
    "modbus_map/tags_plcopen.xml": emit_plc.plcopen_xml,
}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing, compare only")
    check = parser.parse_args().check
    try:
        map_ = load()
        contents = {name: emit(map_).encode("ascii") for name, emit in OUTPUTS.items()}
    except MapError as error:
        for line in error.args:
            print(f"modbus_map/registers.yaml: {line}", file=sys.stderr)
        return 1

    drifted = False
    for name, content in contents.items():
        path = ROOT / name
        if path.exists() and path.read_bytes() == content:
            continue
        if check:
            print(
                f"{name} is not what modbus_map/registers.yaml makes. "
                "Run: python3 modbus_map/generate.py",
                file=sys.stderr,
            )
            drifted = True
        else:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
            print(f"wrote {name}")
    return 1 if drifted else 0


if __name__ == "__main__":
    sys.exit(main())
