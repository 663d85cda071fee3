# SPDX-License-Identifier: GPL-2.0-or-later
"""Attributes in an .xml changed and the seal behind them (sdk/checksum.hpp) made right again: what somebody writes who knows the format. Knows nothing of YADE."""
import functools
import itertools
import math
import re
import struct
import zlib

LEAF = re.compile(rb'^(\t*)<(\w+)>(.*)</\2>$')
SEAL = re.compile(rb'^\t*<seal>(\d+)</seal>$')
INTEGERS = (-1, 0, 1, 2, 3, 5, 6, 7, 9, 64, 500000, 0x7fffffff, -0x80000000)
REALS = (b'0', b'-1', b'1', b'1e300', b'-1e300', b'1e-300', b'inf', b'-inf', b'nan')


@functools.lru_cache(4)
def _seals(data):
	"""(lines, numbers of those with a seal)."""
	lines = data.split(b'\n')
	return lines, [k for k, line in enumerate(lines) if SEAL.match(line)]


def _step(line):
	"""By how much a line leads deeper: 1 opens an element, -1 closes one, 0 is a value or base64."""
	line = line.lstrip(b'\t')
	return -1 if line.startswith(b'</') else 0 if not line.startswith(b'<') or b'</' in line else 1


def _children(lines, start, end):
	"""[(first line, line after the last)] of the elements in lines start ... end."""
	found = []
	while start < end:
		stop, depth = start + 1, _step(lines[start])
		while depth > 0: depth, stop = depth + _step(lines[stop]), stop + 1
		found.append((start, stop))
		start = stop
	return found


def _attributes(lines, end):
	"""The same of the attributes in front of the seal at line `end`; what the base class stores comes first and is left out."""
	start, depth = end, 0
	while depth >= 0: start, depth = start - 1, depth - _step(lines[start - 1])
	return _children(lines, start + 1, end)[1:]


def _kinds(text):
	"""What a scalar may be, as struct's letters; s: text."""
	if re.fullmatch(rb'-?(\d\.\d+e[+-]\d+|nan|inf)', text): return 'd'
	if re.fullmatch(rb'[01]', text): return '?iq'
	if not re.fullmatch(rb'-?\d+', text): return 's'
	return 'iq' if abs(int(text)) < 1 << 31 else 'q'


def _pieces(lines, spans):
	"""[(line or None, bytes or None, text)] that the seal is made of, in order: values by line, and lengths. Blobs and other objects add nothing."""
	out = []
	for a, b in spans:
		leaf = LEAF.match(lines[a])
		if leaf:
			out.append((a, None, leaf[3]))
			continue
		inside = _children(lines, a + 1, b - 1)
		first = lines[inside[0][0]].strip()
		if first.startswith((b'<px', b'<size>')): continue
		if first.startswith(b'<count>'):
			out.append((None, struct.pack('<Q', int(LEAF.match(lines[inside[0][0]])[3])), b''))
			inside = inside[1:]
		elif re.match(rb'<(x|w|m00)>', first):  # vector, quaternion, matrix: in the order in which they lie in memory
			out.append((None, struct.pack('<Q', len(inside)), b''))
			if first.startswith(b'<m00>'): inside = inside[0::3] + inside[1::3] + inside[2::3]
			elif len(inside) == 4: inside = sorted(inside, key=lambda span: b'xyzw'.index(lines[span[0]].strip()[1:2]))
		out += _pieces(lines, inside)
	return out


def _bytes(kind, text):
	if kind == 's':
		text = text.replace(b'&quot;', b'"').replace(b'&apos;', b"'").replace(b'&lt;', b'<').replace(b'&gt;', b'>').replace(b'&amp;', b'&')
		return struct.pack('<Q', len(text)) + text
	return struct.pack('<' + kind, float(text) if kind == 'd' else int(text))


def _sum(pieces, kinds):
	kinds, out = iter(kinds), b''
	for _, known, text in pieces:
		out += known if known is not None else _bytes(next(kinds), text)
	return zlib.crc32(out)


_found = {}


def _typesOf(lines, end, spans, pieces):
	"""The kind of each value, found by trying: those with which the seal is right. None when it is none of those known."""
	key = tuple(re.split(rb'[ >]', lines[a].strip())[0] for a, _ in spans) + (len(pieces), )
	want = int(SEAL.match(lines[end])[1])
	values = [p for p in pieces if p[1] is None]
	if key in _found and _sum(pieces, _found[key]) == want: return _found[key]
	groups = []  # items of one vector are of one kind
	for line, _, text in values:
		item = LEAF.match(lines[line])[2] == b'item'
		if item and groups and groups[-1][0] == line - 1: groups[-1] = line, groups[-1][1] + [text]
		else: groups.append((line, [text]))
	choices = [sorted(set.intersection(*map(set, map(_kinds, texts)))) or 's' for _, texts in groups]
	if math.prod(map(len, choices)) > 1 << 18: return None
	for kinds in itertools.product(*choices):
		kinds = [k for k, (_, texts) in zip(kinds, groups) for _ in texts]
		if _sum(pieces, kinds) == want:
			_found[key] = kinds
			return kinds
	return None


def madeRight(random, data):
	"""(new data, what was done) or None."""
	lines, ends = _seals(data)
	if not ends: return None
	end = random.choice(ends)
	spans = _attributes(lines, end)
	pieces = _pieces(lines, spans)
	values = [p for p in pieces if p[1] is None]
	kinds = _typesOf(lines, end, spans, pieces) if values else None
	if kinds is None: return None
	k = random.randrange(len(values))
	line, _, text = values[k]
	kind = kinds[k]
	if kind == 'd': new = random.choice(REALS + (b'%.17g' % (float(text) * random.uniform(0.5, 2)), ))
	elif kind == '?': new = b'1' if text == b'0' else b'0'
	elif kind == 's': new = random.choice((b'', b'x', b'linear', b'right', b'affine', b'y' * 300))
	else: new = b'%d' % random.choice(INTEGERS)
	return _changed(lines, end, pieces, kinds, line, new), 'seal made right, %s %s -> %s' % (LEAF.match(lines[line])[2].decode(), text.decode(), new.decode())


def _changed(lines, end, pieces, kinds, line, new):
	"""The file with another value in a line, and the seal at line `end` to go with it."""
	lines, was = list(lines), LEAF.match(lines[line])
	lines[line] = b'%s<%s>%s</%s>' % (was[1], was[2], new, was[2])
	lines[end] = re.sub(rb'\d+', b'%d' % _sum([(a, b, new if a == line else t) for a, b, t in pieces], kinds), lines[end])
	return b'\n'.join(lines)


def withValue(data, name, new):
	"""The file with another value in the first attribute of this name, and its seal made right; None when there is none."""
	lines, ends = _seals(data)
	for end in ends:
		spans = _attributes(lines, end)
		line = next((a for a, b in spans if b == a + 1 and LEAF.match(lines[a])[2] == name), None)
		if line is None: continue
		pieces = _pieces(lines, spans)
		return _changed(lines, end, pieces, _typesOf(lines, end, spans, pieces), line, new)


def known(data):
	"""(objects whose seal was understood, all with values): how much of a file madeRight() reaches."""
	lines, ends = _seals(data)
	good = every = 0
	for end in ends:
		spans = _attributes(lines, end)
		pieces = _pieces(lines, spans)
		if not any(p[1] is None for p in pieces): continue
		every += 1
		good += _typesOf(lines, end, spans, pieces) is not None
	return good, every
