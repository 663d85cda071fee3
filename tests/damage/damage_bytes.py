# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the plugin's arrays stand in a file, and how a file is damaged. Knows nothing of YADE."""
import base64
import gzip
import hashlib
import json
import re
import struct
import zlib

import damage_seals

KIND = b'mca-blob'
HEAD = struct.Struct('<8sIIQ24s')  # sdk/Blob.hpp: kind, format, checksum, length, version

#: what has upset readers before: limits of integers, numbers that are none, lengths, indices just outside
WORDS = [struct.pack('<d', v) for v in (0., -1., 1e300, -1e300, 1e-300, float('inf'), float('nan'))] + [struct.pack('<q', v) for v in (
        -1, 0, 1, 2, 64, 1 << 20, 1 << 28, 0x7fffffff, 0x80000000, 0xffffffff, 1 << 33, 1 << 40, (1 << 63) - 1)]


def blobs(data):
	"""[(start, end)] of the arrays in YADE's binary format, length and head included; also in the format without heads, for figures of older versions."""
	found = []
	for m in re.finditer(re.escape(KIND), data):
		n, = struct.unpack_from('<Q', data, m.start() - 8)
		if n == HEAD.size + HEAD.unpack_from(data, m.start())[3]: found.append((m.start() - 8, m.start() + n))
	if found: return found
	for m in re.finditer(rb'(?=(.{8})(.{8})(?:\x01|\x38)\x00{7})', data, re.S):
		size, n = struct.unpack('<QQ', m[1] + m[2])
		if 64 < size <= len(data) - m.start() - 8 and (size == n + 16 or size >= 16 + 56 * n > 16 and data[m.start() + 16] == 56):
			if not found or m.start() >= found[-1][1]: found.append((m.start(), m.start() + 8 + size))
	return found


def xmlBlobs(data):
	"""The same in xml: the elements `state` that hold arrays."""
	return [m.span() for m in re.finditer(rb'<state>\s*<size>.*?</state>', data, re.S)]


def checksum(data):
	"""Of head and arrays, with the place of the checksum itself taken as zero."""
	return zlib.crc32(data[:12] + bytes(4) + data[16:])


def contents(data):
	"""The bytes of all arrays of a scene in the binary format."""
	return [data[a:b] for a, b in blobs(data)]


def stored(data, form):
	"""The same of a file in any format; an .xml packs them in base64."""
	if form != 'xml': return contents(data if form == 'yade' else _unpacked(data) if form == 'yade.gz' else _inside(data))
	found = []
	for a, b in xmlBlobs(data):
		whole = b''.join(base64.b64decode(m[1]) for m in re.finditer(rb'<data>(.*?)</data>', data[a:b], re.S))
		found.append(struct.pack('<Q', len(whole)) + whole)
	return found


def _change(random, data, at):
	"""One damage at byte `at`: (new data, what was done)."""
	kind = random.choice(('flip', 'flip', 'byte', 'bytes', 'word', 'word', 'cut', 'insert', 'remove'))
	if kind == 'flip': return data[:at] + bytes([data[at] ^ 1 << random.randrange(8)]) + data[at + 1:], kind
	if kind == 'byte': return data[:at] + bytes([random.randrange(256)]) + data[at + 1:], kind
	if kind == 'bytes':
		n = random.randrange(2, 64)
		return data[:at] + random.randbytes(n) + data[at + n:], kind
	if kind == 'word':
		w = random.choice(WORDS)[:random.choice((4, 8))]
		return data[:at] + w + data[at + len(w):], kind
	if kind == 'cut': return data[:at], kind
	if kind == 'insert': return data[:at] + random.randbytes(random.randrange(1, 32)) + data[at:], kind
	return data[:at] + data[at + random.randrange(1, 32):], kind


def _inText(random, data, at):
	"""In xml: digits and letters rather than any byte, so that the reader is not stopped by the first."""
	kind = random.choice(('digit', 'digit', 'longer', 'any'))
	if kind == 'any': return _change(random, data, at)
	if kind == 'digit':
		c = random.choice(b'0123456789') if chr(data[at]).isdigit() else random.choice(b'ABCDabcd+/')
		return data[:at] + bytes([c]) + data[at + 1:], kind
	digits = [m.span() for m in re.finditer(rb'\d+', data[max(0, at - 200):at + 200])]
	if not digits: return _change(random, data, at)
	a, b = (max(0, at - 200) + v for v in random.choice(digits))
	return data[:a] + str(random.choice((0, 1, 999999, 500000, 4294967295, 1 << 40, 1 << 62, -1))).encode() + data[b:], kind


def _place(random, spans, length):
	"""A byte in the arrays (twice of three) or anywhere, the lengths in front of the arrays oftener than others."""
	if not spans or random.random() < 1 / 3: return random.randrange(length)
	a, b = random.choice(spans)
	return a + random.randrange(min(100, b - a)) if random.random() < 0.2 else random.randrange(a, b)


def _madeRight(random, data):
	"""Arrays changed inside, their checksum made right again: a made-up state. None in the format without checksums."""
	spans = [(a, b) for a, b in blobs(data) if data[a + 8:a + 16] == KIND]
	if not spans: return None
	a, b = random.choice(spans)
	kind, form, _, _, writer = HEAD.unpack_from(data, a + 8)
	body, what = data[a + 8 + HEAD.size:b], ''
	for _ in range(random.choice((1, 1, 2))):
		body, what = _change(random, body, random.randrange(len(body)))
		if not body: return None
	head = HEAD.pack(kind, form, 0, len(body), writer)
	head = HEAD.pack(kind, form, checksum(head + body), len(body), writer)
	return data[:a] + struct.pack('<Q', len(head) + len(body)) + head + body + data[b:], 'checksum made right, ' + what


def _xmlMadeRight(random, data):
	"""The same in xml: the arrays of one piece only."""
	spans = [s for s in xmlBlobs(data) if data[s[0]:s[1]].count(b'<data>') == 2]
	if not spans: return None
	a, b = random.choice(spans)
	pieces = [base64.b64decode(m[1]) for m in re.finditer(rb'<data>(.*?)</data>', data[a:b], re.S)]
	made = _madeRight(random, struct.pack('<Q', sum(map(len, pieces))) + b''.join(pieces))
	if made is None: return None
	whole = made[0][8:]
	text = b'<state>\n<size>%d</size>\n' % len(whole) + b''.join(b'<data>\n%s\n</data>\n' % base64.b64encode(p) for p in (whole[:HEAD.size], whole[HEAD.size:])) + b'</state>'
	return data[:a] + text + data[b:], made[1]


def first(a, b):
	"""First byte that differs."""
	n = min(len(a), len(b))
	step = 4096
	for i in range(0, n, step):
		end = min(n, i + step)
		if a[i:end] != b[i:end]: return next(k for k in range(i, end) if a[k] != b[k])
	return n


def _checkpoint(random, data, scene, damaged):
	"""The scene inside a checkpoint replaced, lengths and checksums made right again."""
	magic, _, text, body = data.split(b'\n', 3)
	head = json.loads(text)
	parts = [body[:head['lengths'][0]], damaged]
	head.update(lengths=[len(p) for p in parts], sha256=[hashlib.sha256(p).hexdigest() for p in parts])
	text = json.dumps(head).encode() + b'\n'
	return b''.join((magic + b'\n', hashlib.sha256(text).hexdigest().encode() + b'\n', text, *parts))


def _inside(data):
	"""The scene in a checkpoint."""
	_, _, text, body = data.split(b'\n', 3)
	return body[json.loads(text)['lengths'][0]:]


def damage(random, form, data):
	"""(damaged file, what was done, whether the first changed byte of the scene is the plugin's, whether a made-up state may be accepted)."""
	if form == 'xml':
		dice = random.random()
		made = _xmlMadeRight(random, data) if dice < 0.2 else damage_seals.madeRight(random, data) if dice < 0.4 else None
		if made: return made[0], made[1], True, True
		spans = xmlBlobs(data)
		bad, what = _inText(random, data, _place(random, spans, len(data)))
		at = first(data, bad)
		return bad, what, any(a <= at < b for a, b in spans), False
	scene = data if form == 'yade' else gzip.decompress(data) if form == 'yade.gz' else _inside(data)
	if form != 'yade' and random.random() < 0.5:  # the file itself
		bad, what = _change(random, data, random.randrange(len(data)))
		return bad, 'file: ' + what, form == 'yade.gz' and _ours(scene, _unpacked(bad)), False
	made = _madeRight(random, scene) if random.random() < 0.4 else None
	if made: bad, what, at = made[0], made[1], None
	else:
		bad, what = _change(random, scene, _place(random, blobs(scene), len(scene)))
	ours = _ours(scene, bad)
	if form == 'yade.gz': bad = gzip.compress(bad, 1, mtime=0)
	if form == 'checkpoint': bad = _checkpoint(random, data, scene, bad)
	return bad, what, ours, bool(made)


def _unpacked(data):
	d, out = zlib.decompressobj(31), bytearray()
	try:
		for i in range(len(data)):  # one by one: an error takes with it what its piece had given
			out += d.decompress(data[i:i + 1])
	except zlib.error:
		pass
	return bytes(out)


def _ours(scene, bad):
	at = first(scene, bad)
	return any(a <= at < b for a, b in blobs(scene))
