# SPDX-License-Identifier: GPL-2.0-or-later
"""The Google Benchmark programs of tests/bench, run when they are built, and their numbers."""
import json
import os
import re
import subprocess
from pathlib import Path

from .. import environment

#: program -> (filter of a quick run, or None for all)
PROGRAMS = {'bench_grid': 'step.*plastic.*/(64|256)/1/', 'bench_automata': '.*/(32|128)/1(/|$)|kernel', 'bench_space': '.*/14/1(/|$)'}
FULL = {'bench_grid': '.', 'bench_automata': '.', 'bench_space': '.'}
LIMIT = 600  #: longest time of one program [s]
TARGETS = {r'Feature::johnsonCook>/\d+/1/': 25.}  #: pattern of a name -> ns per cell and step (at most)


def folder():
	"""Where the programs are when they have been built."""
	return Path(os.environ.get('YADE_MCA_BUILD') or environment.SOURCE / 'build') / 'bench'


def run(quick, where=None):
	"""({program: rows}, remarks): rows are dicts with name, time [ns] of an iteration and the counters; remarks say which program is missing or failed."""
	found, remarks = {}, []
	for program, short in PROGRAMS.items():
		path = (where or folder()) / program
		if not os.access(path, os.X_OK):
			remarks.append('%s is not built (build target %s)' % (program, program))
			continue
		command = [str(path), '--benchmark_format=json', '--benchmark_filter=' + (short if quick else FULL[program])]
		try:
			done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=LIMIT, env=dict(os.environ, OMP_WAIT_POLICY='passive', GOMP_SPINCOUNT='1000'))
			found[program] = [row(b) for b in json.loads(done.stdout)['benchmarks']]
		except (subprocess.TimeoutExpired, ValueError, KeyError) as e:
			remarks.append('%s failed: %s' % (program, ' '.join(str(e).split())[:200]))
	return found, remarks


def row(b):
	"""One benchmark: its name, nanoseconds of an iteration, and what the program counts (ns_per_cell, GB/s, ...)."""
	scale = dict(ns=1., us=1e3, ms=1e6, s=1e9)[b['time_unit']]
	known = ('name', 'family_index', 'per_family_instance_index', 'run_name', 'run_type', 'repetitions', 'repetition_index', 'threads', 'iterations', 'real_time', 'cpu_time', 'time_unit', 'label')
	return dict(name=b['name'], time=b['real_time'] * scale, **{k: v for k, v in b.items() if k not in known})


def add(report, found):
	"""The counters in ns as cases of the report; some have a limit."""
	for program, rows in found.items():
		for r in rows:
			for k, v in r.items():
				if k.startswith('ns_per') or k in ('GB/s', 'GF/s'):
					limit = next((ns for what, ns in TARGETS.items() if k == 'ns_per_cell' and re.search(what, r['name'])), None)
					report.add('%s/%s/%s' % (program, r['name'].replace('/real_time', '').replace('/manual_time', ''), k), v, limit=limit, unit=k if '/' in k else 'ns', passed=v <= limit if limit else None)
