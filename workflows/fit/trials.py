"""Runs of a search, by the sweep's engine: rows of a table that grows. A run with the same values is never made twice."""

import os
import pathlib
import subprocess
import sys

from common import InputError, NotDone, csv_text, read_csv, read_rows, write_changed
from inputs import inputs_of

ENDED = {"done", "refused", "failed", "unbalanced"}
SWEEP = pathlib.Path(__file__).resolve().parent.parent / "sweep" / "sweep.py"


class Trials:
    def __init__(self, scene, names, folder, programs):
        self.scene, self.names, self.folder, self.programs = scene, names, folder, programs
        self.table, self.sources = folder / "table.csv", folder / "table.inputs"
        self.made = 0
        # Rows belong to the scene, its files and the programs as they were.
        self.inputs = inputs_of(scene, programs, [])
        self.rows = []
        if self.table.is_file() and self.sources.is_file() and self.sources.read_text(encoding="utf-8") == self.inputs:
            header, *rows = read_csv(self.table)
            self.rows = [tuple(row) for row in rows] if header == names else []

    def ended(self):
        """Rows of sweep.csv by the texts of their values."""
        path = self.folder / "runs" / "sweep.csv"
        if not self.rows or not path.is_file():
            return {}
        rows = read_rows(path)
        if not rows or list(rows[0])[1 : len(self.names) + 1] != self.names:
            return {}
        return {tuple(row[name] for name in self.names): row for row in rows
                if row["status"] in ENDED and (row["status"] != "done" or (self.results(row) / "run.json").is_file())}

    def results(self, row):
        return self.folder / "runs" / row["run"] / f"{row['run']}.results"

    def run(self, wanted):
        """Makes the runs of these tuples of texts that are missing. A row of sweep.csv for each."""
        ended = self.ended()
        missing = [values for values in dict.fromkeys(wanted) if values not in ended]
        if missing:
            if not self.rows:  # what is there belongs to another scene or other keys
                (self.folder / "runs" / "sweep.csv").unlink(missing_ok=True)
            self.rows += [values for values in missing if values not in self.rows]
            self.folder.mkdir(parents=True, exist_ok=True)
            write_changed(self.sources, self.inputs)
            write_changed(self.table, csv_text([self.names, *self.rows]))
            said = self.sweep()
            ended = self.ended()
            stopped = [values for values in missing if values not in ended]
            if stopped:
                raise NotDone([f"{len(stopped)} of {len(missing)} runs were stopped or not started; call make again.", *said[-10:]])
            self.made += len(missing)
        return [ended[values] for values in wanted]

    def sweep(self):
        """Makes the rows of the table. What the engine says, by lines."""
        variables = {"SCENE": str(self.scene), "SWEEP": str(self.table.resolve()), "SWEEP_FOLDER": str(self.folder.resolve() / "runs"),
                     "PROGRAMS": str(self.programs)}
        # make's job slots are open files.
        ended = subprocess.run([sys.executable, SWEEP], env=os.environ | variables, close_fds=False, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        lines = ended.stdout.strip().splitlines()
        if ended.returncode not in (0, 1):
            raise InputError(lines)
        return lines
