# SPDX-License-Identifier: GPL-2.0-or-later
"""One measured run of `bench` in a process of its own, so that threads, environment and memory are its own.

    python -m yade_mca.tasks.bench.process JOB FILE      job as JSON; writes the record, a JSON object
"""
import importlib
import json
import os
import subprocess
import sys
import time

from ..attempts import inMemory
from .plan import LAWS, name

MODULES = dict(elasticWave='waves', plasticShock='waves', taylorBar='bodies', plateWave='bodies', penetration='bodies', law='law', space='law')
LIMIT = 1800  #: longest time of a process [s]
SHORT, REPEATS, LONG = 0.6, 3, 8.  #: a run is repeated until its steps have taken this long [s], so many times at most; one that takes longer than LONG [s] only once


def execute(job):
	"""Runs a job in this process, whose scene it replaces; returns the record. Short runs are repeated and the fastest counts.

	Where the account is off and energies are of interest, one more run keeps it and gives `energyError`.
	"""
	from ... import _yade
	from . import meter
	case = importlib.import_module(__package__ + '.' + MODULES[job['case']]).CASES[job['case']]

	def made(**changes):
		_yade.scene().reset()
		return case(dict(job, **changes))

	_yade.scene()  # loads YADE and the plugin, which counts as start
	record = dict(job, name=name(job), **meter.machine())
	since = lambda: time.time() - job['started'] if 'started' in job else None
	record['start'] = since()
	try:
		found = [made()]
	except RuntimeError as e:  # what engines raise
		return dict(record, ended=' '.join(str(e).split()), memory=meter.peakMemory())
	record.update(wall=since(), memory=meter.peakMemory())
	if job['case'] not in LAWS:
		while len(found) < REPEATS and sum(f['stepping'] for f in found) < SHORT:
			found.append(made())
		best = min(found, key=lambda f: f['stepping'])
		if not job['account'] and job['threads'] == 1 and job['solver'] in ('automata', 'grid', 'coupled') and best['stepping'] < LONG:
			best['energyError'] = made(account=True)['energyError']
	return dict(record, **min(found, key=lambda f: f['stepping']), runsMade=len(found))


def measured(job):
	"""Runs a job in a new process and returns its record; a process that broke gives a record with `failed`."""
	environment = dict(os.environ, OMP_NUM_THREADS=str(job['threads']), OMP_WAIT_POLICY='passive', GOMP_SPINCOUNT='1000')
	with inMemory('record.json') as path:
		try:
			done = subprocess.run([sys.executable, '-m', __spec__.name, json.dumps(dict(job, started=time.time())), path], env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, timeout=LIMIT)
			said = (done.stderr.strip().splitlines() or ['status %d' % done.returncode])[-1]
		except subprocess.TimeoutExpired:
			said = 'stopped after %d s' % LIMIT
		if not os.path.getsize(path):
			return dict(job, name=name(job), failed=said)
		with open(path) as f:
			record = json.load(f)
	record.pop('started', None)
	return record


def main():
	from ..report import jsonable, writeAtomically
	job, path = json.loads(sys.argv[1]), sys.argv[2]
	writeAtomically(path, json.dumps(jsonable(execute(job))))


if __name__ == '__main__':
	main()
