#!/usr/bin/env python3
"""Manual page and shell completion of a program, from what its --help says.

    command_line.py man TEMPLATE VERSION DOCDIR PROGRAM  one page; TEMPLATE has what --help does not say
    command_line.py complete TEMPLATE PROGRAM...         one bash script for all programs

The layout of --help is that of CLI11: a section "Options:" and the like, an entry per line with its text from
column 30 on, or on the next line where the entry is longer. Options of a group are indented further.
"""

import dataclasses
import os
import pathlib
import re
import subprocess
import sys
import time

TEXT_COLUMN = 30


@dataclasses.dataclass
class Entry:
    """An option, a positional argument or a subcommand."""

    names: list
    value: str = ""  # placeholder of the value; empty for a flag
    notes: list = dataclasses.field(default_factory=list)  # bounds, default and the like, a sentence each
    repeats: bool = False
    required: bool = False
    text: str = ""


@dataclasses.dataclass
class Command:
    """A program or one of its subcommands."""

    name: str
    sentence: str = ""
    entries: dict = dataclasses.field(default_factory=dict)  # of each section, by its title
    subcommands: list = dataclasses.field(default_factory=list)

    @property
    def positionals(self):
        return self.entries.get("Positionals", [])

    @property
    def options(self):
        return self.entries.get("Options", [])


# --- Reading --help ---------------------------------------------------------------------------------------

def parse_entry(left, text):
    """`left` is for example "--threads INT:INT in [1 - 8]=4 ... REQUIRED Excludes: --all"."""
    names, _, rest = left.strip().partition(" ")
    entry = Entry(names.split(","), text=text)
    for word, note in (("Excludes", "Not together with"), ("Needs", "Only together with")):
        rest, _, others = rest.partition(f"{word}: ")
        if others:
            entry.notes.append(f"{note} {others.replace(' ', ', ')}.")
    entry.required = "REQUIRED" in rest
    entry.repeats = " ..." in " " + rest
    rest = re.sub(r"(^|\s)(REQUIRED|\.\.\.)", "", rest).strip()
    rest, _, default = rest.rpartition("=") if re.search(r"=[^A-Z]*$", rest) else (rest, "", "")
    entry.value, _, bounds = rest.partition(":") if re.search(r":\w+ in ", rest) else (rest, "", "")
    between = re.search(r"in \[(.*) - (.*)\]", bounds)
    if between:
        entry.notes.append(f"From {between[1]} to {between[2]}.")
    if default:
        entry.notes.append(f"Default: {default}.")
    return entry


def parse_help(name, output):
    lines = output.splitlines()
    command = Command(name, sentence=lines[0].removeprefix(name + ": "))
    section = None
    for number, line in enumerate(lines):
        heading = re.fullmatch(r" *(Positionals|Options|Subcommands):", line)
        entry = re.match(r"( {2}| {4})\S", line)
        if heading:
            section = command.entries.setdefault(heading[1], [])
        elif line and not line.startswith(" "):
            section = None  # text after the lists, or the name of a group of options
        elif section is not None and entry:
            column = TEXT_COLUMN + len(entry[1]) - 2
            following = lines[number + 1] if number + 1 < len(lines) else ""
            on_next_line = following.startswith(" " * TEXT_COLUMN) and line[column - 2:column] != "  "
            left, text = (line, following) if on_next_line else (line[:column], line[column:])
            section.append(parse_entry(left, text.strip()))
    if not command.options:
        sys.exit(f"command_line.py: {name} --help: got no options; expected the layout of CLI11")
    return command


def ask(program, *subcommand):
    name = pathlib.Path(program).name
    output = subprocess.run([program, *subcommand, "--help"], check=True, capture_output=True, text=True).stdout
    command = parse_help(" ".join([name, *subcommand]), output)
    for entry in command.entries.get("Subcommands", []):
        command.subcommands.append(ask(program, *subcommand, entry.names[0]))
    return command


# --- Manual page ------------------------------------------------------------------------------------------

def escaped(text):
    """Text for troff. A minus of an option or a number must not become a hyphen, nor a dot at the start a macro."""
    text = re.sub(r"(?<![A-Za-z])-|-(?=-)", r"\\-", text.replace("\\", r"\e"))
    return r"\&" + text if text.startswith((".", "'")) else text


def sentence_of(text):
    text = text if re.match(r"\w+[_.]", text) else text[:1].upper() + text[1:]
    return text if text.endswith((".", ":")) else text + "."


def synopsis(command):
    words = [rf"\fB{escaped(command.name)}\fR", "[OPTIONS]"]
    for entry in command.positionals:
        name = entry.names[0].upper() + (" ..." if entry.repeats else "")
        words.append(rf"\fI{name}\fR" if entry.required else rf"[\fI{name}\fR]")
    if command.subcommands:
        words.insert(1, r"\fISUBCOMMAND\fR")
    return " ".join(words)


def item(entry, positional):
    if positional:
        head = rf"\fI{entry.names[0].upper()}\fR"
    else:
        value = rf" \fI{escaped(entry.value)}\fR" if entry.value else ""
        head = ", ".join(rf"\fB{escaped(name)}\fR" for name in entry.names) + value
    notes = list(entry.notes)
    if entry.required and not positional:
        notes.append("Required.")
    return "\n".join([".TP", head, escaped(" ".join([sentence_of(entry.text), *notes]))])


def items(command, but=()):
    lines = [item(entry, True) for entry in command.positionals]
    lines += [item(entry, False) for entry in command.options if not set(entry.names) & set(but)]
    return lines


def manual_page(template, version, docdir, program):
    command = ask(program)
    usage = [synopsis(command)]
    options = items(command)
    for subcommand in command.subcommands:
        usage += [".br", synopsis(subcommand)]
        options += [f".SS {escaped(subcommand.name)}", escaped(sentence_of(subcommand.sentence)),
                    *items(subcommand, but=["--help"])]
    date = time.strftime("%Y-%m-%d", time.gmtime(int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))))
    page = template.read_text()
    shared = (template.parent / "exit-status.man").read_text()
    for word, text in {"SYNOPSIS": "\n".join(usage), "OPTIONS": "\n".join(options), "EXIT_STATUS": shared.strip(),
                       "VERSION": version, "DATE": date, "DOCDIR": docdir}.items():
        page = page.replace(f"@{word}@", text)
    return page


# --- Completion -------------------------------------------------------------------------------------------

def kind_of_value(entry):
    """What the bash script offers for a value: see the template."""
    choices = re.findall(r'"([\w-]+)"', entry.text) if re.match("one of ", entry.text, re.I) else []
    if re.fullmatch(r"[a-z]+(\|[a-z]+)+", entry.value):
        choices = entry.value.split("|")
    if choices:
        return "words " + " ".join(choices)
    if entry.names[0] == "RESULTS":
        return "results"
    extension = re.search(r"\.[a-z][a-z0-9.]*$", entry.value)
    if extension:
        return "files " + extension[0]
    if entry.value == "FOLDER":
        return "folders"
    if entry.value == "FILE":
        return "files .toml" if "TOML" in entry.text else "files"
    return "any"


def completion(template, programs):
    lines = []
    for command in [c for program in programs for top in [ask(program)] for c in [top, *top.subcommands]]:
        words = [name for entry in command.options for name in entry.names if name.startswith("--")]
        lines.append(f"_suffuse_options['{command.name}']='{' '.join(words)}'")
        if command.subcommands:
            names = [subcommand.name.split()[-1] for subcommand in command.subcommands]
            lines.append(f"_suffuse_subcommands['{command.name}']='{' '.join(names)}'")
        for entry in command.options:
            for name in entry.names if entry.value else []:
                lines.append(f"_suffuse_values['{command.name} {name}']='{kind_of_value(entry)}'")
        for place, entry in enumerate(command.positionals):
            lines.append(f"_suffuse_values['{command.name} @{place}']='{kind_of_value(entry)}'")
            if entry.repeats:
                lines.append(f"_suffuse_values['{command.name} @more']='{kind_of_value(entry)}'")
    names = " ".join(pathlib.Path(program).name for program in programs)
    return template.read_text().replace("@TABLES@", "\n".join(lines)).replace("@PROGRAMS@", names)


def main(arguments):
    wanted, template, *rest = arguments
    page = manual_page if wanted == "man" else lambda path, *programs: completion(path, programs)
    sys.stdout.write(page(pathlib.Path(template), *rest))


main(sys.argv[1:])
