# SPDX-License-Identifier: GPL-2.0-or-later
"""Checkpoints: the whole scene and what a script wants to keep beside it, in one file that is whole or absent.

    >>> checkpoint.write('run.checkpoint', dict(seed=1), dict(time=t))     # O as it stands between two steps
    >>> facts, arrays = checkpoint.read('run.checkpoint')                  # O is that scene again

Layout: a line that names the format, a line of JSON (lengths and SHA-256 of the parts, version, facts), the arrays (npz), the scene (YADE's
binary format). A file that is cut, damaged, of another kind or of another version of the plugin is refused before anything is touched.

The checksums show damage, not intent: a scene may hold engines (PyRunner) that run Python. Trust a checkpoint, as a .yade or .xml, like a program.
"""
import hashlib
import io
import json
import os
import re

import numpy as np

from ._yade import scene
from .tasks.report import jsonable, writeAtomically

__all__ = ['CheckpointError', 'pack', 'peek', 'read', 'removeLeftovers', 'store', 'write']

MAGIC = b'yade-mca checkpoint 1\n'


class CheckpointError(RuntimeError):
	"""A checkpoint that cannot be used; the message says why."""


def _version():
	import yade_mca
	return getattr(yade_mca, 'version', None)


def write(path, facts, arrays):
	"""Saves the scene O with `facts` (what JSON can hold) and `arrays` ({name: numpy array}). O must not be running.

	The new file replaces an older one only when it is complete on the disk; raises OSError (e.g. disk full) otherwise, and the older one stays.
	"""
	store(path, *pack(facts, arrays))


def pack(facts, arrays):
	"""(head, parts) of what write() saves, for store(), which may be called in another process."""
	packed = io.BytesIO()
	np.savez(packed, **arrays)
	parts = [packed.getvalue(), scene().sceneToString()]
	return dict(version=_version(), lengths=[len(p) for p in parts], facts=jsonable(facts)), parts


def store(path, head, parts):
	"""Writes what pack() gave, as write() does. Needs no YADE."""
	head = dict(head, sha256=[hashlib.sha256(p).hexdigest() for p in parts])
	text = json.dumps({k: head[k] for k in ('version', 'lengths', 'sha256', 'facts')}).encode() + b'\n'
	writeAtomically(path, b''.join((MAGIC, hashlib.sha256(text).hexdigest().encode() + b'\n', text, *parts)))
	folder = os.open(os.path.dirname(os.path.abspath(path)), os.O_RDONLY)
	try:
		os.fsync(folder)  # the new name, too, is on the disk
	finally:
		os.close(folder)


def _parse(path):
	try:
		with open(path, 'rb') as f:
			data = f.read()
	except OSError as e:
		raise CheckpointError("cannot read checkpoint '%s': %s" % (path, e.strerror)) from None
	if not data.startswith(MAGIC):
		raise CheckpointError("'%s' is not a checkpoint of this program" % path)
	damaged = CheckpointError("checkpoint '%s' is damaged: its content does not fit its checksum; start the run anew or use another checkpoint" % path)
	try:
		_, digest, text, body = data.split(b'\n', 3)
		if hashlib.sha256(text + b'\n').hexdigest().encode() != digest:
			raise damaged
		head = json.loads(text)
	except ValueError as e:
		raise damaged from e
	parts = []
	for length, digest in zip(head['lengths'], head['sha256']):
		parts.append(body[:length])
		body = body[length:]
		if len(parts[-1]) != length or hashlib.sha256(parts[-1]).hexdigest() != digest:
			raise damaged
	if body:
		raise damaged
	return head, parts


def peek(path):
	"""Facts of a checkpoint, after all checks, without touching the scene. Raises CheckpointError."""
	return _parse(path)[0]['facts']


def _classes(saved):
	"""Names of YADE's classes in a scene in the binary format: each stands there in full, with its length in front, where the first object of it is."""
	starts = (m.start() for m in re.finditer(rb'(?=\x00{7}yade::)', saved))
	return {saved[i + 7:i + 7 + saved[i - 1]][6:].decode('ascii', 'replace') for i in starts if i > 0}


def _checkEngines(path, saved, engines):
	"""Raises CheckpointError when the scene holds an engine, functor or callback whose class is not in `engines`."""
	from ._yade import yadeClass
	for name in sorted(_classes(saved) - set(engines)):
		try:
			known = yadeClass(name)
		except ImportError:
			known = None
		if known is None or any(issubclass(known, yadeClass(base)) for base in ('Engine', 'Functor', 'IntrCallback')):
			raise CheckpointError("checkpoint '%s' holds %s, which this program does not make: whatever it does would be run; load it with checkpoint.read() if you trust it" % (path, name))


def read(path, engines=None):
	"""Puts the saved scene in the place of O and returns (facts, arrays). Raises CheckpointError; O is untouched then.

	engines: names of the classes of engines that the scene may hold; any other is refused before the scene is made. None: all, for files that one trusts like programs.
	"""
	head, (packed, saved) = _parse(path)
	if head['version'] != _version():
		raise CheckpointError("checkpoint '%s' was written by version %s, this is %s: it would not go on identically" % (path, head['version'], _version()))
	if engines is not None:
		_checkEngines(path, saved, engines)
	with np.load(io.BytesIO(packed), allow_pickle=False) as z:
		arrays = {k: z[k] for k in z.files}
	scene().stringToScene(saved)
	return head['facts'], arrays


def removeLeftovers(path):
	"""Removes unfinished files that a killed process has left beside `path`."""
	folder, name = os.path.split(os.path.abspath(path))
	for f in os.listdir(folder):
		if f.startswith('.' + name + '.'):
			os.unlink(os.path.join(folder, f))
