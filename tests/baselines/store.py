# SPDX-License-Identifier: GPL-2.0-or-later
"""Baselines on disk: GROUP.json holds {name: {value, tolerance, unit, why, commit}}; `tolerance` is the largest absolute difference."""
import json
import math
import subprocess
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
KEYS = {'value', 'tolerance', 'why', 'commit'}


class BaselineError(Exception):
	"""A baseline that cannot be read or changed; one line that says what and what to do."""


def path(group):
	return FOLDER / (group + '.json')


def load(group):
	"""{name: entry} of a group, {} when it has no file. Raises BaselineError for a file that is not whole."""
	if not path(group).exists():
		return {}
	try:
		entries = json.loads(path(group).read_text())
	except ValueError as e:
		raise BaselineError('%s is not JSON: %s' % (path(group), e)) from None
	for name, e in entries.items():
		lacking = KEYS - set(e)
		if lacking or not str(e['why']).strip() or not math.isfinite(e['value']) or not e['tolerance'] > 0:
			raise BaselineError("%s: '%s' needs a finite value, a tolerance above 0, why and commit" % (path(group), name))
	return entries


def save(group, entries):
	path(group).write_text(json.dumps(entries, indent=1, sort_keys=True) + '\n')


def compare(group, measured):
	"""Rows (name, stored or None, now, tolerance or None, holds) of a group, sorted; a number without a baseline, or the other way round, does not hold."""
	entries, rows = load(group), []
	for name in sorted({*entries, *measured}):
		e, now = entries.get(name), measured.get(name)
		holds = e is not None and now is not None and abs(now - e['value']) <= e['tolerance']
		rows.append((group + '/' + name, e and e['value'], now, e and e['tolerance'], holds))
	return rows


def changed(group, measured, only, why, tolerance, commit):
	"""(old entries, new entries) of a group with the measured values of `only` (None: all). Raises BaselineError without a reason or a tolerance."""
	if not (why or '').strip():
		raise BaselineError('a baseline changes only with its reason: give --why TEXT')
	if tolerance is not None and not 0 < tolerance < math.inf:
		raise BaselineError('--tolerance must be above 0 and finite; got %r' % tolerance)
	if only is not None and only not in measured:
		raise BaselineError("group '%s' has no number '%s'; it has %s" % (group, only, ', '.join(sorted(measured))))
	old = load(group)
	new = dict(old)
	for name, value in measured.items():
		if only is not None and name != only: continue
		if not math.isfinite(value):
			raise BaselineError("'%s/%s' is %r; only a finite number can be a baseline" % (group, name, value))
		allowed = tolerance if tolerance is not None else old.get(name, {}).get('tolerance')
		if allowed is None:
			raise BaselineError("'%s/%s' is new: give --tolerance X, the largest absolute difference, and the reason for it in --why" % (group, name))
		new[name] = dict(value=float(value), tolerance=allowed, why=why.strip(), commit=commit)
	return old, new


def currentCommit():
	"""Commit of the source tree, with '+' when files under version control other than the baselines were changed."""
	git = lambda *words: subprocess.run(['git', '-C', str(FOLDER), *words], capture_output=True, text=True)
	head = git('rev-parse', 'HEAD')
	if head.returncode:
		raise BaselineError('there is no git commit here to record: %s' % head.stderr.strip().split('\n')[0])
	dirty = git('status', '--porcelain', '--untracked-files=no', '--', ':/', ':(exclude,top)tests/baselines/*.json').stdout.strip()
	return head.stdout.strip() + ('+' if dirty else '')
