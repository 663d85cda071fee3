# SPDX-License-Identifier: GPL-2.0-or-later
"""Damaged files: thousands of random damages of each format (bytes flipped, cut, inserted, lengths changed, checksums made right again) are refused, or load what was saved. None crashes,
takes more than 1 GB or changes a number of the plugin silently; damage_server.py says what is counted as ours. `python3 tests/damage/test_damage.py [COUNT]` prints the counts of COUNT damages
(2000) of each format."""
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import damage_bytes
import damage_seals
from damage_scenes import FORMATS, SCENES


def process(*words):
	r = subprocess.run(['/usr/bin/python3', *map(str, words)], capture_output=True, text=True, env=dict(os.environ, MPLBACKEND='Agg', OMP_NUM_THREADS='1'))
	assert r.returncode == 0, 'status %d: %s' % (r.returncode, r.stdout[-2000:] + r.stderr[-4000:])
	return r.stdout


def makeAll(folder):
	for s in SCENES:
		process(HERE / 'damage_scenes.py', s, folder)
	return folder


@pytest.fixture(scope='module')
def folder(tmp_path_factory):
	return makeAll(tmp_path_factory.mktemp('scenes'))


def damages(folder, scene, form, count, seed):
	return json.loads(process(HERE / 'damage_server.py', folder / ('%s.%s' % (scene, form)), form, count, seed).splitlines()[-1])


def check(folder, form, count, seed):
	for scene in SCENES:
		r = damages(folder, scene, form, count, seed)
		print(scene, form, r['cases'], 'memory %.0f MB' % (r['worstMemory'] / 1024))
		assert not [w for w in r['wrong'] if w['where'] == 'ours' or w['verdict'] == 'silent'], (scene, form, r['wrong'])
		refused = sum(n for k, n in r['cases'].items() if k.startswith('refused'))
		assert refused > 0.3 * count and sum(r['cases'].values()) == count, r['cases']


@pytest.mark.parametrize('form', FORMATS)
def test_damagedFilesAreRefusedOrLoadWhatWasSaved(folder, form):
	check(folder, form, 50, 1)


@pytest.mark.study
@pytest.mark.parametrize('form', FORMATS)
def test_twoThousandDamagesOfEachFormat(folder, form):
	check(folder, form, 500, 2)


def refusal(path):
	"""What loading says in a fresh process; '' when it loads and makes two steps."""
	return process('-c', """
import yade_mca
from yade import O
try:
	O.load(%r)
	O.run(2, True)
except Exception as e: print('refused:' + str(e).strip().replace('\\n', '|'))
else: print('refused:')
""" % str(path)).rsplit('refused:', 1)[1].strip()


def edited(folder, scene, pattern, replacement):
	"""The xml file of a scene with the first match replaced."""
	text = (folder / (scene + '.xml')).read_text()
	new, n = re.subn(pattern, replacement, text, count=1, flags=re.S)
	assert n == 1 and new != text
	path = folder / 'edited.xml'
	path.write_text(new)
	return path


@pytest.mark.parametrize('scene, pattern, replacement, word', [
        ('automata', r'(<order>.*?<item>)\d+(</item>)', r'\g<1>500000\2', 'McaEngine'),
        ('automata', r'(<order>\s*<count>)\d+(</count>)', r'\g<1>3\2', ''),
        ('automata', r'(<order>\s*<count>)\d+(</count>)', r'\g<1>4000000000\2', ''),
        ('automata', r'(<viscous>.*?<item>.*?<x>)[^<]+(</x>)', r'\g<1>77\2', 'McaEngine'),
        ('automata', r'(<dtFactor>)[^<]+(</dtFactor>)', r'\g<1>0.2\2', 'McaEngine'),
        ('automata', r'(<plasticStrain>)[^<]+(</plasticStrain>)', r'\g<1>0.5\2', 'McaState'),
        ('automata', r'(<shearModulus>)[^<]+(</shearModulus>)', r'\g<1>1e9\2', 'McaMat'),
        ('grid', r'(<sleeping>)1(</sleeping>)', r'\g<1>0\2', 'McaGridEngine'),
        ('coupled', r'(<side>)left(</side>)', r'\1right\2', 'McaGridCoupler'),
        ('law2', r'(<slot>)\d(</slot>)', r'\g<1>9\2', 'McaPhys'),
])
def test_editedAttributesAreRefusedInOneSentence(folder, scene, pattern, replacement, word):
	said = refusal(edited(folder, scene, pattern, replacement))
	assert said and word in said and '|' not in said, said
	assert not word or ('damaged' in said and 'edited' in said), said


@pytest.mark.parametrize('scene, name, value, word', [
        ('law2', 'slot', '9', 'slot = 9'),
        ('law2', 'slot', '-1', 'slot = -1'),
        ('law2', 'wall', '1', ''),
        ('law2', 'flags', '-1', 'flags = -1'),
        ('law2', 'rule', '3', 'rule = 3'),
        ('automata', 'dtFactor', 'nan', 'dtFactor'),
        ('grid', 'dtFactor', '-1', 'dtFactor'),
])
def test_aRightSealDoesNotLetIndicesOrNumbersThrough(folder, scene, name, value, word):
	"""Who edits an attribute and makes the seal right, too, is told by the check of the attribute itself, or the value is one that it may have."""
	data = (folder / (scene + '.xml')).read_bytes()
	new = damage_seals.withValue(data, name.encode(), value.encode())
	assert new and new != data
	path = folder / 'sealed.xml'
	path.write_bytes(new)
	said = refusal(path)
	assert word in said and (said or not word) and 'seal' not in said, said


def test_bodiesUnderWrongNumbersAreRefused(folder):
	for scene in 'automata', 'law2':
		said = refusal(edited(folder, scene, r'(<Serializable object_id="_\d+"></Serializable>\s*<id>)11(</id>)', r'\g<1>500000\2'))
		assert 'stands in the place of body 11' in said, said


def test_attributesOfStockYadeStayEditable(folder):
	assert refusal(edited(folder, 'automata', r'(<dead>)0(</dead>)', r'\g<1>0 \2')) == ''


@pytest.mark.parametrize('scene', ['automata', 'grid', 'coupled'])
def test_filesWithoutChecksumAreRefusedWithTheReason(folder, scene):
	"""As an older version has written them: the length, then at once the arrays."""
	data = (folder / (scene + '.yade')).read_bytes()
	for a, b in reversed(damage_bytes.blobs(data)):
		body = data[a + 8 + damage_bytes.HEAD.size:b]
		data = data[:a] + len(body).to_bytes(8, 'little') + body + data[b:]
	path = folder / 'old.yade'
	path.write_bytes(data)
	said = refusal(path)
	assert 'older version' in said and 'has written it and must load it' in said, said


def test_theCheckOfTheHarness(folder):
	"""The harness finds the arrays, and their checksums are those of zlib."""
	for scene, n in ('automata', 1), ('grid', 1), ('coupled', 4), ('law2', 0):
		data = (folder / (scene + '.yade')).read_bytes()
		found = damage_bytes.blobs(data)
		assert len(found) == len(damage_bytes.xmlBlobs((folder / (scene + '.xml')).read_bytes())) == n
		for a, b in found:
			kind, form, crc, length, writer = damage_bytes.HEAD.unpack_from(data, a + 8)
			assert kind == damage_bytes.KIND and form == 2 and length == b - a - 8 - damage_bytes.HEAD.size and writer.rstrip(b'\0')
			assert crc == damage_bytes.checksum(data[a + 8:b])
		understood, seals = damage_seals.known((folder / (scene + '.xml')).read_bytes())
		assert understood == seals > 0


if __name__ == '__main__':
	each, total = int((sys.argv + ['2000'])[1]) // len(SCENES), {}
	with tempfile.TemporaryDirectory() as where:
		makeAll(Path(where))
		for form in FORMATS:
			for scene in SCENES:
				r = damages(Path(where), scene, form, each, 2)
				print('%-10s %-9s %s, memory %.0f MB' % (form, scene, ', '.join('%s %d' % c for c in sorted(r['cases'].items())), r['worstMemory'] / 1024), flush=True)
				for w in r['wrong'][:5]: print('    ', w)
				for k, n in r['cases'].items(): total[k] = total.get(k, 0) + n
	print('all        %s' % ', '.join('%s %d' % c for c in sorted(total.items())))
