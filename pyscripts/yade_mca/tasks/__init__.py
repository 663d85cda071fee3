# SPDX-License-Identifier: GPL-2.0-or-later
"""The tasks behind `pyscripts/run TASK`: `python -m yade_mca.tasks TASK ...` with YADE's interpreter.

A task is a module of this package, or task.py of a folder in it, with

    SUMMARY                              one line for the help
    addArguments(parser)                 its own options (argparse)
    check(args)                          optional; raises UsageError for values it cannot accept, before anything is built
    run(args, report, progress)          does the job; report is a Report, progress(total, label, unit) makes a progress bar

and an entry in `registry.TASKS`. Status of the process: 0 all that was asserted holds, 1 not, 2 wrong options.
"""
from .registry import UsageError
from .report import Case, Report

__all__ = ['Case', 'Report', 'UsageError']
