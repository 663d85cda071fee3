# SPDX-License-Identifier: GPL-2.0-or-later
"""What the loader wants to know of a shared library without loading it."""
import os
import struct


def _header(path):
	with open(path, 'rb') as file:
		head = file.read(4096)
	if len(head) < 64 or head[:6] != b'\x7fELF\x02\x01': raise ValueError('%s is not a library of this kind of machine (64 bit, little endian)' % path)
	return head


def checkWhole(path):
	"""Raises ValueError when the file ends before its own table of contents does: mapping such a file kills the process on first touch."""
	head = _header(path)
	programs, sections = struct.unpack_from('<QQ', head, 32)
	programSize, programCount, sectionSize, sectionCount = struct.unpack_from('<HHHH', head, 54)
	size = os.path.getsize(path)
	if max(programs + programSize * programCount, sections + sectionSize * sectionCount) > size:
		raise ValueError('%s is cut short (%d bytes)' % (path, size))


def buildId(path):
	"""The linker's identity of a library as hexadecimal text, '' if it has none."""
	head = _header(path)
	at = head.find(b'\x04\0\0\0\x14\0\0\0\x03\0\0\0GNU\0')  # name of 4 bytes, 20 bytes, type build-id
	return head[at + 16:at + 36].hex() if at > 0 else ''


def needed(path):
	"""Names of the libraries that a library asks for (its NEEDED entries), in their order. Raises ValueError when it is damaged."""
	with open(path, 'rb') as file:
		data = file.read()
	_header(path)
	programs, = struct.unpack_from('<Q', data, 32)
	size, count = struct.unpack_from('<HH', data, 54)
	segments = [struct.unpack_from('<IIQQQQ', data, programs + n * size) for n in range(count)]  # type, flags, offset, address, -, bytes in the file
	try:
		start, length = next((s[2], s[5]) for s in segments if s[0] == 2)
		entries = [struct.unpack_from('<QQ', data, at) for at in range(start, start + length, 16)]
		address = next(value for tag, value in entries if tag == 5)  # of the strings
		strings = next(s[2] + address - s[3] for s in segments if s[0] == 1 and s[3] <= address < s[3] + s[5])
		return [data[strings + value:data.index(b'\0', strings + value)].decode() for tag, value in entries if tag == 1]
	except (StopIteration, struct.error) as e:
		raise ValueError('%s has no table of the libraries it needs' % path) from e
