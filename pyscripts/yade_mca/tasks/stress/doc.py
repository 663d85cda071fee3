# SPDX-License-Identifier: GPL-2.0-or-later
"""Tables of the documentation's page on stability (reStructuredText) from a result of the task stress; nothing in them is typed by hand."""
import json
import os
import re
import sys

from ..penetration.doc import listTable, madeBy

#: first words of the names -> what the cases are
GROUPS = {
        'step/automata': 'time step, automata: 0.05 to 0.999 of the limit; 1.001 to infinite, zero, not a number',
        'step/grid': 'time step, cells: the same',
        'limit': 'limit of stability itself, from the eigenvalues of the forces',
        'impact/automata': 'two blocks of automata, 10 m/s to 6 km/s',
        'impact/coupled': 'block on a coupled plate, 10 m/s to 6 km/s',
        'impact/orientation': 'orientation of the packing, every 5 degrees',
        'impact/oblique': 'oblique impact, 10 to 80 degrees',
        'material/b': 'slope b of the shock adiabat, 0 to 3',
        'material/nu': "Poisson's ratio, 0 to 0.5",
        'material/yield': 'yield stress, 0 to infinite',
        'material/density': 'ratio of densities, 1 to 100: in contact, joined, in cells',
        'material/viscosity': 'viscosity, 0 to 10 times the default',
        'material/wrong': 'constants that make no sense',
        'lattice': 'automata moved at random by 1 to 30 % of the spacing',
        'interface': 'edge of the grid at the interface, 0.3 to 9 spacings',
        'drift': 'free vibration over many steps',
        'evenOdd': 'shortest waves behind a shock',
        'random': 'random scenes',
        'space/step': 'in space: time step, 0.05 to 0.999 of the limit; 1.001 to infinite, zero, not a number',
        'space/limit': 'in space: limit of stability itself, from the eigenvalues of the forces',
        'space/impact': 'in space: two bodies, 10 m/s to 6 km/s',
        'space/material': "in space: Poisson's ratio, yield stress, slope of the shock adiabat at their ends",
        'space/drift': 'in space: free vibration over many steps',
        'space/random': 'in space: random scenes',
}


def within(outcomes, prefix):
	return [o for o in outcomes if re.match(re.escape(prefix) + r'(?![a-zA-Z])', o['name'])]


def small(x):
	return '' if x is None else '%.1e' % x if abs(x) < 1e-3 else '%.4f' % x


def summary(outcomes):
	rows, of = [], lambda part, key: max((o['measures'][key] for o in part if isinstance(o['measures'].get(key), float)), default=None)
	for prefix, words in GROUPS.items():
		part = within(outcomes, prefix)
		if not part: continue
		count = lambda kind: sum(o['outcome'] == kind for o in part)
		held = [o for o in part if o['outcome'] == 'held' and 'energy' in o['measures']]
		bound = max((o['energyBound'] for o in held), default=None)
		rows.append((words, count('held'), count('refused'), count('failed'), small(of(held, 'energy')), '' if bound is None else '%.2g' % bound, small(of(held, 'booked')), small(of(held, 'momentum'))))
	return listTable('What held, what was refused, what failed; largest errors of those that held', ('cases', 'held', 'refused', 'failed', 'energy sum', 'its bound', 'booked energy', 'momentum'), rows)


def values(outcomes, prefix, title, head):
	rows = [(o['name'][len(prefix) + 1:], small(o['measures']['value']), o['outcome']) for o in outcomes if o['name'].startswith(prefix + '/') and 'value' in o['measures']]
	return listTable(title, (head, 'value', ''), rows) if rows else ''


def literal(text):
	return '``%s``' % text.replace('`', "'")


def refusals(outcomes):
	"""One example for each kind of message: the text without its numbers tells the kind."""
	seen = {}
	for o in outcomes:
		if o['outcome'] == 'refused':
			seen.setdefault(re.sub(r"[-+]?(\d[\d.e+-]*|nan|inf)|'[^']*'", '#', o['text'])[:60], o)
	return listTable('One refusal of each kind', ('case', 'message'), [(o['name'], literal(o['text'])) for o in seen.values()])


def failures(outcomes):
	rows = [(o['name'], literal(o['text'])) for o in outcomes if o['outcome'] == 'failed']
	return listTable('What failed', ('case', 'why'), rows) if rows else 'Nothing failed.\n'


def page(data):
	"""The tables of one result, text."""
	out = data['stress']['outcomes']
	parts = [summary(out), failures(out), values(out, 'limit', 'Measured over predicted limit of the time step', 'state'), values(out, 'drift', 'Change of the mean energy', 'body'),
	         values(out, 'evenOdd', 'Shortest wave over the mean pressure', 'run'), refusals(out), madeBy(data, 'stress --quick' if data['stress']['quick'] else 'stress')]
	return '\n'.join(p for p in parts if p)


def write(folder):
	"""Writes FOLDER/stress.inc from FOLDER/stress.json."""
	from ..report import writeAtomically
	with open(os.path.join(folder, 'stress.json')) as f:
		writeAtomically(os.path.join(folder, 'stress.inc'), page(json.load(f)))


if __name__ == '__main__':
	write(sys.argv[1])
