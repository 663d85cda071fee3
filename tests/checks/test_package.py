# SPDX-License-Identifier: GPL-2.0-or-later
"""The Debian package: lintian finds no error, it depends on exactly this YADE, touches no file of YADE's, and works from where it is unpacked."""
import os
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get('YADE_MCA_BUILD', ROOT / 'build'))


def run(*command, **options):
	return subprocess.run([str(c) for c in command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300, **options)


def dpkgVersion(name):
	return run('dpkg-query', '-W', '-f', '${Version}', name).stdout


@pytest.fixture(scope='module')
def package(tmp_path_factory):
	folder = tmp_path_factory.mktemp('package')
	done = run('cpack', '-G', 'DEB', '--config', BUILD / 'CPackConfig.cmake', '-B', folder, cwd=folder)
	found = list(folder.glob('*.deb'))
	assert done.returncode == 0 and len(found) == 1, done.stdout
	return found[0]


@pytest.fixture(scope='module')
def unpacked(package):
	root = package.parent / 'root'
	assert run('dpkg-deb', '-x', package, root).returncode == 0
	return root


def test_lintianFindsNoError(package):
	done = run('lintian', '--fail-on', 'error', package)
	assert done.returncode == 0 and not re.search(r'^E: ', done.stdout, re.M), done.stdout


def test_dependsOnThisYadeOnly(package):
	yade = dpkgVersion('libyade')
	depends = run('dpkg-deb', '-f', package, 'Depends').stdout
	assert 'libyade (= %s)' % yade in depends and ' yade (= %s)' % yade in ' ' + depends
	for library in ('libgomp1', 'libstdc++6', 'libboost-python1', 'libboost-serialization1', 'libpython3.', 'libc6 (>= '):
		assert library in depends, depends


def test_namesTheReleaseItIsFor(package):
	release = dict(line.strip().split('=', 1) for line in open('/etc/os-release') if '=' in line)
	series = 'deb' + release['VERSION_ID'].strip('"') if 'VERSION_ID' in release else release['VERSION_CODENAME']
	assert re.fullmatch(r'yade-mca_[\d.]+~%su1_amd64.deb' % re.escape(series), package.name), package.name


def test_librariesNeedNothingThatIsNotDeclared(package, unpacked):
	"""Each library they ask for lies in the package itself, in YADE's folder, or in a package that Depends names."""
	depends = {d.split()[0] for d in re.split(r'[,|]', run('dpkg-deb', '-f', package, 'Depends').stdout)}
	libraries = list(unpacked.rglob('*.so'))
	assert len(libraries) >= 2
	for library in libraries:
		for name in re.findall(r'NEEDED.*\[(.*?)\]', run('readelf', '-d', library).stdout):
			if name in ('libmcasolver.so', 'libyade.so', 'libpkg_dem.so', 'libpkg_common.so'): continue
			path = re.search(r'^\s*%s \(.*=> (\S+)' % re.escape(name), run('/sbin/ldconfig', '-p').stdout, re.M)[1]
			owners = {line.split(':')[0] for p in (path, os.path.realpath(path)) for line in run('dpkg', '-S', '*' + p.removeprefix('/usr')).stdout.splitlines() if ' ' in line}
			assert owners & depends, (library.name, name, path, owners)


def test_noFileIsAnotherPackages(unpacked):
	files = ['/' + str(p.relative_to(unpacked)) for p in unpacked.rglob('*') if not p.is_dir()]
	owned = set(run('dpkg', '-L', 'yade', 'libyade').stdout.split('\n'))
	assert files and not set(files) & owned
	# nothing in a place that YADE or Python reads at start of its own accord
	for path in files:
		assert not path.startswith(('/usr/lib/x86_64-linux-gnu', '/etc')) and not path.endswith(('.pth', 'sitecustomize.py')), path


def test_worksFromWhereItIs(unpacked, tmp_path):
	environment = {k: v for k, v in os.environ.items() if k not in ('YADE_MCA_LIB', 'YADE_MCA_BUILD')}
	environment['PYTHONPATH'] = str(unpacked / 'usr/lib/python3/dist-packages')
	(tmp_path / 'script.py').write_text("import yade_mca\nprint('FROM', yade_mca.__file__, len(yade_mca.classes), yade_mca.guardChecks)\n")
	for command in ([unpacked / 'usr/bin/yade-mca', '-n', '-x', 'script.py'], ['yade', '-n', '-x', 'script.py'], ['/usr/bin/python3', 'script.py']):
		done = run(*command, cwd=tmp_path, env=environment)
		assert done.returncode == 0 and 'FROM ' + str(unpacked) in done.stdout, done.stdout
	done = run(unpacked / 'usr/bin/yade-mca', 'info', cwd=tmp_path, env=environment)
	assert done.returncode == 0 and 'guardChecks' in done.stdout, done.stdout
	done = run(unpacked / 'usr/bin/yade-mca', 'check', '--frob', cwd=tmp_path, env=environment)
	assert done.returncode == 2 and '\nyade-mca: unrecognized' in '\n' + done.stdout, done.stdout
	assert not list(unpacked.rglob('*.orig'))
