# SPDX-License-Identifier: GPL-2.0-or-later
"""What a measured run costs: time by phase from YADE's timers of engines, processor time, memory, and the machine it ran on."""
import os
import re
import resource
import sys
import time
from functools import lru_cache
from pathlib import Path

from ... import _yade
from .. import environment

#: what McaEngine calls its phases -> names of the record
AUTOMATA = {'search': 'neighbours', 'density': 'density', 'stress': 'pairs', 'force': 'forces', 'contact': 'contacts', 'fracture': 'fracture', 'integration': 'integration'}
#: part of McaEngine's time that is in none of its phases: write-back is measured apart and taken off
REST = 'rest'
#: phases of the grid and of what ties it; all others are those of automata
GRID, INTERFACE = ('cells', 'nodes'), ('interface', )


class Meter:
	"""Counts time and steps of the scene from here on: build the scene, make a Meter, run by its steps() and until().

	automata, grid: the engines or None; couplers: those that tie them; roads in YADE's own loop need none of the three. What a PyRunner costs is not counted.
	"""

	def __init__(self, automata=None, grid=None, couplers=()):
		self.O = _yade.scene()
		self.automata, self.grid, self.couplers = automata, grid, list(couplers)
		self.O.timingEnabled = True
		if automata: automata.ids  # builds its solver, which is no part of a step
		self.runs = 0
		self.first, self.before, self.wall, self.cpu = self.O.iter, self.nanoseconds(), time.perf_counter(), time.process_time()

	def steps(self, n):
		"""n steps; raises RuntimeError when the scene was paused or an engine refused."""
		self.runs += 1
		if not _yade.steps(n):
			raise RuntimeError('the run was stopped at step %d' % self.O.iter)

	def until(self, t):
		"""Runs to the first step that reaches time t [s]."""
		if self.O.dt <= 0 or self.O.iter == self.first:
			self.steps(1)
		while self.O.time < t:
			self.steps(max(1, int((t - self.O.time) / self.O.dt / 1.02)))

	def nanoseconds(self):
		"""Phase -> nanoseconds since the start of the process, before write-back is taken from the rest."""
		found = {}
		add = lambda k, v: found.__setitem__(k, found.get(k, 0.) + v)
		for e in self.O.engines:
			if type(e).__name__ not in ('McaEngine', 'McaGridEngine', 'McaGridCoupler', 'PyRunner'): add(type(e).__name__, e.execTime)
		total = self.automata.execTime if self.automata else 0.
		for c in self.couplers:
			for label, ns, _ in c.timingDeltas.data:
				if label == 'integration of the automata': total += ns
				else: add('nodes' if label == 'integration of the grid' else 'interface', ns)
		if self.automata:
			own = {AUTOMATA.get(k, k): v for k, v in self.automata.phases().items()}
			for k, v in own.items():
				add(k, v)
			add(REST, total - sum(own.values()))
		if self.grid:
			if self.couplers: add('cells', self.grid.execTime)
			else:
				for label, ns, _ in self.grid.timingDeltas.data:
					add('cells' if label.startswith('cells') else 'nodes', ns)
				add(REST, self.grid.execTime - sum(ns for _, ns, _ in self.grid.timingDeltas.data))
		return found

	def record(self):
		"""Cost since the Meter was made, dict; see bench.py for the keys."""
		cpu, wall = time.process_time() - self.cpu, time.perf_counter() - self.wall
		after, steps = self.nanoseconds(), self.O.iter - self.first
		spent = {k: v - self.before.get(k, 0.) for k, v in after.items()}
		timers = 1e-9 * sum(spent.values())
		stepping = withoutOthers(timers, cpu)
		spent = {k: v * stepping / timers if timers else v for k, v in spent.items()}
		automata = self.automata.count if self.automata else len(self.O.bodies)
		cells = self.grid.count if self.grid else 0
		if self.automata and automata:
			spent['writeBack'] = min(self.writeBack() * self.runs, max(spent[REST], 0.))
			spent[REST] -= spent['writeBack']
		ofGrid = sum(v for k, v in spent.items() if k in GRID)
		ofAutomata = sum(v for k, v in spent.items() if k not in GRID + INTERFACE)
		perStep = lambda ns, n: ns / n / steps if n and steps else None
		return dict(
		        automata=automata, cells=cells, steps=steps, simulated=self.O.time, stepping=stepping, timers=timers, processorSeconds=cpu, processorShare=cpu / wall if wall else None,
		        automataNs=perStep(ofAutomata, automata), cellNs=perStep(ofGrid, cells), interfaceNs=perStep(spent.get('interface', 0.), 1) if self.couplers else None,
		        phases={k: perStep(v, cells if k in GRID and cells else automata or cells) for k, v in spent.items()}, phasesPerStep={k: perStep(v, 1) for k, v in spent.items()},
		        awake=self.awake(), runs=self.runs
		)

	def awake(self):
		"""Share of the automata's blocks that were computed, mean over all steps; None without automata."""
		c = self.automata.counters() if self.automata and self.automata.count else None
		return c['blockSteps'] / c['blocks'] / c['steps'] if c and c['blocks'] and c['steps'] else None

	def writeBack(self):
		"""Nanoseconds of one write-back to the bodies, best of three."""
		best = float('inf')
		for _ in range(3):
			start = time.perf_counter_ns()
			self.automata.sync()
			best = min(best, time.perf_counter_ns() - start)
		return best


def withoutOthers(timers, processor):
	"""Time of the steps [s]: by the timers or, on one thread, the processor time when it is less. Then other processes had the processor in between."""
	return min(timers, processor) if environment.threads() == 1 else timers


@lru_cache(maxsize=None)
def compiler():
	"""Compiler of the solver library in use, as it has signed the file; None when it has not."""
	with open('/proc/self/maps') as f:
		found = re.search(r'\S*/libmcasolver\.so$', f.read(), re.M)
	if not found:
		return None
	signed = re.search(rb'GCC: \([^)]*\) [\d.]+|clang version [\d.]+', Path(found[0]).read_bytes())
	return signed[0].decode() if signed else None


def machine():
	"""Facts that belong to every record."""
	return dict(threads=environment.threads(), compiler=compiler(), isa=environment.isa(), processor=environment.processor(), commit=environment.commit(), build=getattr(sys.modules.get('yade_mca'), 'commit', None),
	            version=environment.version(), load=os.getloadavg()[0])


def residentMemory():
	"""Resident memory of this process now [bytes]."""
	with open('/proc/self/statm') as f:
		return int(f.read().split()[1]) * resource.getpagesize()


def peakMemory():
	"""Largest resident memory of this process so far [MB]."""
	return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
