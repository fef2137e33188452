# SPDX-License-Identifier: Apache-2.0
"""The IEC 61131-3 library of plc_model.py as structured text and as PLCopen XML (TC6 2.01)."""

import textwrap
from xml.etree import ElementTree

from emit_integrations import SOURCE
from map_model import Map
from plc_model import ArrayType, EnumType, Library, Pou, StructType, Variable, library

# ---- structured text -----------------------------------------------------------------------------


def _comment(text: str, indent: str = "") -> str:
    """Behind a declaration, or before one as a block."""
    text = text.replace("*)", "* )").replace("(*", "( *")
    if not indent:
        return f" (* {text} *)" if text else ""
    return "".join(f"{line}\n" for line in textwrap.wrap(f"(* {text} *)", 96))


def _declaration(variable: Variable) -> str:
    initial = f" := {variable.initial}" if variable.initial else ""
    return f"    {variable.name} : {variable.type}{initial};{_comment(variable.text)}\n"


def _st_type(declared: EnumType | ArrayType | StructType) -> str:
    if isinstance(declared, EnumType):
        names = ",\n".join(f"    {value.name}" for value in declared.values)
        return f"    {declared.name} : (\n{textwrap.indent(names, '    ')}\n    );\n"
    if isinstance(declared, ArrayType):
        return f"    {declared.name} : ARRAY[0..{declared.count - 1}] OF {declared.base};\n"
    members = "".join(_declaration(member) for member in declared.members)
    return f"    {declared.name} : STRUCT\n{textwrap.indent(members, '    ')}    END_STRUCT;\n"


def _st_pou(pou: Pou) -> str:
    kind, returns = ("FUNCTION", f" : {pou.returns}") if pou.returns else ("FUNCTION_BLOCK", "")
    sections = (("VAR_INPUT", pou.inputs), ("VAR_OUTPUT", pou.outputs), ("VAR", pou.local))
    variables = "".join(
        f"{section}\n{''.join(_declaration(variable) for variable in declared)}END_VAR\n"
        for section, declared in sections
        if declared
    )
    body = "".join(f"{line}\n" for line in pou.body)
    return f"{_comment(pou.text, 'block')}{kind} {pou.name}{returns}\n{variables}{body}END_{kind}\n"


def _head(map_: Map) -> str:
    return (
        f"{SOURCE} Modbus map of {map_.product['name']}, version {map_.version}, for IEC 61131-3 "
        "systems: enumerations, structures and function blocks that fill them from the words as "
        "they were read, texts for people, and a function block that gives a command. Addresses "
        "stand in the structures LevelwindAddresses and LevelwindCoils."
    )


def structured_text(map_: Map) -> str:
    made: Library = library(map_)
    types = "".join(
        f"\n{_comment(declared.text, 'block')}TYPE\n{_st_type(declared)}END_TYPE\n"
        for declared in made.types
    )
    pous = "".join(f"\n{_st_pou(pou)}" for pou in made.pous)
    return _comment(_head(map_), "block") + types + pous


# ---- PLCopen XML ---------------------------------------------------------------------------------

_TC6 = "http://www.plcopen.org/xml/tc6_0201"
_XHTML = "http://www.w3.org/1999/xhtml"
_CREATED = "2026-01-01T00:00:00"  # required; the file must not change with the day
_ELEMENTARY = {"BOOL", "WORD", "DWORD", "INT", "UINT", "DINT", "UDINT", "TIME"}
_Element = ElementTree.Element


def _add(parent: _Element, tag: str, **attributes: str) -> _Element:
    return ElementTree.SubElement(parent, tag, attributes)


def _add_text(parent: _Element, tag: str, text: str) -> None:
    if text:
        _add(_add(parent, tag), "xhtml", xmlns=_XHTML).text = text


def _add_type(parent: _Element, name: str) -> None:
    if name == "STRING":
        _add(parent, "string")
    elif name in _ELEMENTARY:
        _add(parent, name)
    else:
        _add(parent, "derived", name=name)


def _add_variables(parent: _Element, variables: list[Variable]) -> None:
    for variable in variables:
        element = _add(parent, "variable", name=variable.name)
        _add_type(_add(element, "type"), variable.type)
        if variable.initial:
            _add(_add(element, "initialValue"), "simpleValue", value=variable.initial)
        _add_text(element, "documentation", variable.text)


def _add_data_type(parent: _Element, declared: EnumType | ArrayType | StructType) -> None:
    data_type = _add(parent, "dataType", name=declared.name)
    base = _add(data_type, "baseType")
    if isinstance(declared, EnumType):
        values = _add(_add(base, "enum"), "values")
        for value in declared.values:
            _add(values, "value", name=value.name, value=str(value.value))
    elif isinstance(declared, ArrayType):
        array = _add(base, "array")
        _add(array, "dimension", lower="0", upper=str(declared.count - 1))
        _add_type(_add(array, "baseType"), declared.base)
    else:
        _add_variables(_add(base, "struct"), declared.members)
    _add_text(data_type, "documentation", declared.text)


def _add_pou(parent: _Element, pou: Pou) -> None:
    kind = "function" if pou.returns else "functionBlock"
    element = _add(parent, "pou", name=pou.name, pouType=kind)
    interface = _add(element, "interface")
    if pou.returns:
        _add_type(_add(interface, "returnType"), pou.returns)
    sections = (("inputVars", pou.inputs), ("outputVars", pou.outputs), ("localVars", pou.local))
    for section, variables in sections:
        if variables:
            _add_variables(_add(interface, section), variables)
    _add_text(interface, "documentation", pou.text)
    _add_text(_add(element, "body"), "ST", "\n".join(pou.body))


def plcopen_xml(map_: Map) -> str:
    made = library(map_)
    project = _Element("project", {"xmlns": _TC6})
    _add(
        project,
        "fileHeader",
        companyName=map_.product["vendor"],
        companyURL=map_.product["url"],
        productName=map_.product["name"],
        productVersion=map_.product_version,
        creationDateTime=_CREATED,
        contentDescription=_head(map_),
    )
    header = _add(project, "contentHeader", name="levelwind", version=str(map_.version))
    coordinates = _add(header, "coordinateInfo")
    for language in ("fbd", "ld", "sfc"):
        _add(_add(coordinates, language), "scaling", x="1", y="1")
    types = _add(project, "types")
    data_types = _add(types, "dataTypes")
    for declared in made.types:
        _add_data_type(data_types, declared)
    pous = _add(types, "pous")
    for pou in made.pous:
        _add_pou(pous, pou)
    _add(_add(project, "instances"), "configurations")
    ElementTree.indent(project)
    return (
        '<?xml version="1.0" encoding="utf-8"?>\n' + ElementTree.tostring(project, "unicode") + "\n"
    )
