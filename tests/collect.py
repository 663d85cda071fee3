# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs the GoogleTest programs and the pytest files and counts their tests; called by tests/run, which sets up the environment.

Every program and every pytest file is a process of its own, so a crash costs one file and YADE starts afresh in each. Two run at once by default.
"""
import argparse
import concurrent.futures
import os
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

TESTS = Path(__file__).resolve().parent
BUILD = Path(os.environ.get('YADE_MCA_BUILD', TESTS.parent / 'build'))
STUDY = 'study'


def labels():
	"""All labels: folders with tests, and those of the built programs."""
	folders = {p.parent.name for p in TESTS.glob('*/test_*.py')}
	programs = {p.name for p in (BUILD / 'tests').glob('*') if any(isProgram(f) for f in p.glob('*'))}
	return sorted((folders | programs) - {'CMakeFiles'})


def isProgram(path):
	return path.is_file() and os.access(path, os.X_OK) and path.suffix == '' and not path.name.startswith('.')


def jobsOf(wanted):
	"""(name, command) of each process for the labels and files wanted; the command still lacks the name of its report."""
	jobs = []
	study = STUDY in wanted
	for label in labels():
		if label not in wanted and not study: continue
		if label != STUDY or study:
			for program in sorted((BUILD / 'tests' / label).glob('*')):
				if isProgram(program) and label in wanted: jobs.append(('%s/%s' % (label, program.name), [str(program), '--gtest_brief=1', '--gtest_output=xml:']))
		for file in sorted((TESTS / label).glob('test_*.py')):
			if label in wanted: jobs.append(pytestJob(file, 'not study'))
			if study and 'mark.study' in file.read_text(): jobs.append(pytestJob(file, 'study'))
	for name in wanted:
		if name.endswith('.py'): jobs.append(pytestJob(Path(name).resolve(), ''))
	return jobs


def pytestJob(file, marks):
	name = os.path.relpath(file, TESTS)[:-3] + (' (study)' if marks == 'study' else '')
	return name, ['/usr/bin/python3', '-m', 'pytest', '-q', '-c', str(TESTS / 'pytest.ini'), '--rootdir', str(TESTS), '-m', marks, str(file), '--junitxml=']


def counts(report):
	"""(passed, failed, skipped) of a report in JUnit's form, which pytest and GoogleTest both write."""
	passed = failed = skipped = 0
	for case in ElementTree.parse(report).iter('testcase'):
		tags = {child.tag for child in case}
		if tags & {'failure', 'error'}: failed += 1
		elif 'skipped' in tags or case.get('status') == 'notrun' or case.get('result') == 'skipped': skipped += 1
		else: passed += 1
	return passed, failed, skipped


def runJob(name, command, limit):
	start = time.time()
	with tempfile.TemporaryDirectory() as folder:
		report = Path(folder) / 'report.xml'
		try:
			process = subprocess.run(
			        command[:-1] + [command[-1] + str(report)], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
			        errors='replace', timeout=limit
			)
			output, status = process.stdout, process.returncode
		except subprocess.TimeoutExpired as e:
			output, status = (e.stdout or b'').decode(errors='replace') + '\nstopped after %g s' % limit, -1
		try:
			passed, failed, skipped = counts(report)
		except (OSError, ElementTree.ParseError):
			passed, failed, skipped = 0, 0, 0
	nothing = status == 5 and 'pytest' in command  # pytest: no test selected
	if status != 0 and not nothing and failed == 0: failed = 1  # it ended badly without saying which test
	if status == 0 and passed + failed + skipped == 0: failed = 1  # a program without tests
	return name, passed, failed, skipped, time.time() - start, output


def main():
	parser = argparse.ArgumentParser(prog='tests/run', description='Run the tests. Labels: %s, study.' % ', '.join(labels()))
	parser.add_argument('what', nargs='*', help='labels or pytest files; default: all labels but study')
	parser.add_argument('-j', '--jobs', type=int, default=os.cpu_count(), help='processes at once')
	parser.add_argument('-v', '--verbose', action='store_true', help='show the output of all, not only of what failed')
	parser.add_argument('-l', '--list', action='store_true', help='list what would run')
	parser.add_argument('--limit', type=float, default=900, help='longest time of one process [s]')
	options = parser.parse_args()
	known = labels() + [STUDY]
	wanted = options.what or [x for x in known if x != STUDY]
	for name in wanted:
		if name not in known and not (name.endswith('.py') and Path(name).exists()):
			parser.error('no tests called %s; labels are %s' % (name, ', '.join(known)))
	jobs = jobsOf(wanted)
	if options.list:
		print('\n'.join(name for name, _ in jobs))
		return 0
	totals = [0, 0, 0]
	broken = []
	start = time.time()
	with concurrent.futures.ThreadPoolExecutor(max(1, options.jobs)) as pool:
		for done in concurrent.futures.as_completed([pool.submit(runJob, name, command, options.limit) for name, command in jobs]):
			name, passed, failed, skipped, seconds, output = done.result()
			totals = [a + b for a, b in zip(totals, (passed, failed, skipped))]
			print('%-50s %4d passed %3d failed %6.1f s%s' % (name, passed, failed, seconds, '  (%d skipped)' % skipped if skipped else ''), flush=True)
			if failed: broken.append(name)
			if failed or options.verbose: print('\n'.join('    ' + line for line in output.splitlines()[-120:]), flush=True)
	if broken: print('failed: ' + ', '.join(sorted(broken)))
	if totals[2]: print('%d skipped' % totals[2])
	print('%.0f s' % (time.time() - start))
	print('%d passed, %d failed' % (totals[0], totals[1]))
	return 0 if totals[1] == 0 and totals[0] > 0 else 1


if __name__ == '__main__':
	sys.exit(main())
