# SPDX-License-Identifier: GPL-2.0-or-later
"""Judges what a bad value has come to, for test_every_call.py: refused before anything moved, in words that help, or not."""
import re

import every_call_table as table


def positions():
	from yade import O
	out = []
	for b in O.bodies:
		if b.state is not None: out.append(tuple(b.state.pos))
	for e in O.engines:
		if type(e).__name__ == 'McaGridEngine' and e.count: out += [e.view(k, c).tobytes() for k in range(len(e.blocks)) for c in 'xy']
	return repr(out)


RANGE = re.compile(r"\d|must|allowed|one of|known are|there are|remedy|instead|finite|\b(make|set|give|use|call|take|add|put|name)\b", re.I)
WHERE = re.compile(r"\bMca\w+|\bbody|\bbodies|material '|automat|block|packing|scene|O\.\w+|\bgrid\b", re.I)


def poor(error, what, where=()):
	"""What the message of a refusal lacks, or ''. Boost.Python's own refusal of a type is taken as it is: it stands at the line that sets.

	what: words of which it must have one; where: words that say where, besides those of WHERE.
	"""
	text = str(error)
	if type(error).__name__ == 'ArgumentError' or isinstance(error, (AttributeError, OverflowError)) or 'No registered converter' in text: return ''
	lacks = []
	if not any(n.lower() in text.lower() for n in what): lacks.append('what')
	if not WHERE.search(text) and not any(w.lower() in text.lower() for w in where): lacks.append('where')
	if not RANGE.search(text): lacks.append('allowed or remedy')
	return ', '.join(lacks)


def attempt(act, after, what, accepted, still=True, where=()):
	"""(verdict, text) of a bad value: `act` makes the call, `after` the steps that follow. still: whether nothing moves meanwhile. what, where: see poor()."""
	start = None
	try:
		act()
		if still: start = positions()
		after()
	except Exception as e:
		if start is not None and positions() != start: return 'moved', told(e)
		return refusal(e, [''] if accepted else what, where)
	return ('accepted' if accepted else 'silent'), ''


def told(error): return '%s: %s' % (type(error).__name__, error)


def refusal(error, what=('', ), where=()):
	"""(verdict, text) of an error; without words for what it need only say where and what to do."""
	lacks = poor(error, what, where)
	return ('poor', 'lacks %s: %s' % (lacks, told(error))) if lacks else ('refused', told(error))


def words(key):
	"""Words of which a message about this attribute or argument must have one."""
	own = key.split('(')[-1].rstrip(')') if '(' in key else key.split('.')[-1]
	return [own, *table.ALSO_CALLED.get(key, table.ALSO_CALLED.get(own, ()))]
