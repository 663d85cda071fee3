# SPDX-License-Identifier: GPL-2.0-or-later
"""finish.py ROOT SOURCE VERSION YADE_LIBDIR MAINTAINER PACKAGE_VERSION SUITE: makes a staged installation ready for a package: libraries stripped, manifest of what is installed,
manual pages and change log compressed, permissions."""
import glob
import gzip
import os
import subprocess
import sys


def compressed(path, data):
	os.makedirs(os.path.dirname(path), exist_ok=True)
	with open(path, 'wb') as f:
		f.write(gzip.compress(data, 9, mtime=0))


def dateOf(source):
	"""Of the last commit; a fixed one outside of git or without it."""
	try:
		date = subprocess.run(['git', '-C', source, 'log', '-1', '--format=%aD'], capture_output=True, text=True).stdout.strip()
	except OSError:
		date = ''
	return date or 'Thu, 01 Jan 2026 00:00:00 +0000'


def main(root, source, version, yadeLibDir, maintainer, packageVersion, suite):
	lib = os.path.join(root, 'lib/python3/dist-packages/yade_mca/lib')
	for path in glob.glob(os.path.join(lib, '**', '*.so'), recursive=True):
		subprocess.run(['strip', '--strip-unneeded', '--remove-section=.comment', '--remove-section=.note', path], check=True)
	subprocess.run([sys.executable, os.path.join(source, 'plugin/sdk/manifest.py'), lib, version, source, yadeLibDir], check=True)
	with open(os.path.join(source, 'plugin/debian/yade-mca.1'), 'rb') as f:
		page = f.read()
	compressed(os.path.join(root, 'share/man/man1/yade-mca.1.gz'), page)
	compressed(os.path.join(root, 'share/man/man1/yade-mca-batch.1.gz'), b'.so man1/yade-mca.1\n')
	date = dateOf(source)
	compressed(os.path.join(root, 'share/doc/yade-mca/changelog.gz'),
	           ('yade-mca (%s) %s; urgency=medium\n\n  * See plugin/CHANGELOG.md of the sources.\n\n -- %s  %s\n' % (packageVersion, suite, maintainer, date)).encode())
	for folder, _, names in os.walk(root):
		os.chmod(folder, 0o755)
		for name in names:
			path = os.path.join(folder, name)
			if not os.path.islink(path): os.chmod(path, 0o755 if os.path.dirname(path) == os.path.join(root, 'bin') else 0o644)


if __name__ == '__main__':
	main(*sys.argv[1:])
