# SPDX-License-Identifier: GPL-2.0-or-later
"""Finds the compiled part of the plugin, checks that it is whole and fits this YADE, and loads it. Each refusal is an ImportError with a remedy."""
import atexit
import contextlib
import dis
import importlib.machinery
import importlib.util
import io
import json
import os
import shutil
import sys
import tempfile
import types
import zlib

from yade_mca import _elf, _omega

REBUILD = 'delete the folder build and run pyscripts/setup, or reinstall the package yade-mca'


def setThreadPolicy():
	"""Threads of OpenMP that wait sleep instead of spinning, and numpy's products have none, unless the user has said otherwise.

	Without effect on OpenMP when YADE was loaded before, on numpy when that was.
	"""
	os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
	if 'yade' not in sys.modules:
		if os.environ.setdefault('OMP_WAIT_POLICY', 'passive') == 'passive': os.environ.setdefault('GOMP_SPINCOUNT', '1000')


def asksForAll(frame):
	"""Whether the import that runs the package's __init__, called from `frame`, is `import yade_mca` (or `from yade_mca import *`).

	False for one of a module or of single names. Python does not tell a package how it is imported, so this looks at the statement. Where there is none
	to see (a call of importlib) the name decides.
	"""
	while frame and (frame.f_code.co_filename.startswith('<frozen importlib') or frame.f_globals.get('__name__') == 'importlib'):
		if frame.f_locals.get('name', __package__) != __package__: return False  # import yade_mca.measure: the package comes first
		frame = frame.f_back
	if frame is None: return True
	done = [i for i in dis.get_instructions(frame.f_code) if i.offset <= frame.f_lasti and i.opname != 'EXTENDED_ARG']
	if done[-1].opname != 'IMPORT_NAME': return True
	return done[-2].argval in (None, ('*', ))  # the names behind `import` of a from statement


class WithYade:
	"""Import hook for as long as the plugin is not loaded: the first `import yade` of a script brings YADE, wherever it is, and the plugin."""
	hook = None

	def __init__(self, load): self.load = load

	@classmethod
	def place(cls, load):
		"""load(): imports YADE and loads the plugin; it removes the hook before."""
		cls.hook = cls(load)
		sys.meta_path.insert(0, cls.hook)

	@classmethod
	def remove(cls):
		if cls.hook in sys.meta_path: sys.meta_path.remove(cls.hook)

	def find_spec(self, name, path=None, target=None):
		return importlib.machinery.ModuleSpec(name, self) if name == 'yade' else None

	def create_module(self, spec):
		self.load()
		self.spec = sys.modules['yade'].__spec__
		return sys.modules['yade']

	def exec_module(self, module):
		module.__spec__ = self.spec  # the import system has put that of the hook


def refuse(what, remedy):
	raise ImportError('yade_mca: %s. What to do: %s' % (what, remedy)) from None


def installYade(manifest, option=''):
	"""The command that brings the YADE the plugin was built for."""
	version = manifest.get('yadePackage')
	return 'apt-get install %s%s' % (option, 'yade=%s libyade=%s' % (version, version) if version else 'yade (version %s)' % manifest['yade'])


def libraryFolder():
	"""Folder of the compiled part: $YADE_MCA_LIB, or in $YADE_MCA_BUILD, or lib/ inside this package (installed), or the build folder of the source tree."""
	here = os.path.dirname(os.path.abspath(__file__))
	given = os.environ.get('YADE_MCA_LIB')
	build = os.environ.get('YADE_MCA_BUILD')
	candidates = [given] if given else [os.path.join(here, 'lib'), os.path.join(here, '..', '..', 'build', 'yade_mca_lib')]
	if build and not given: candidates.insert(0, os.path.join(build, 'yade_mca_lib'))
	for folder in candidates:
		if os.path.exists(os.path.join(folder, 'manifest.json')):
			return os.path.abspath(folder)
	refuse('the compiled part is not built (looked in %s)' % ', '.join(os.path.abspath(c) for c in candidates), 'run pyscripts/setup, or set YADE_MCA_LIB to its folder')


def readManifest(folder):
	"""What the build wrote down about itself. Raises ImportError when it cannot be read."""
	try:
		with open(os.path.join(folder, 'manifest.json')) as file:
			return json.load(file)
	except (OSError, ValueError) as e:
		refuse('manifest.json cannot be read (%s)' % e, REBUILD)


def checkPython(manifest):
	found = '%d.%d' % sys.version_info[:2]
	if found != manifest['python']:
		refuse(
		        'this is Python %s (%s), the plugin and YADE are for %s' % (found, sys.executable, manifest['python']),
		        'use /usr/bin/python3, or run the script with yade or yade-mca; after an upgrade of the system run pyscripts/setup'
		)


def checkFiles(folder, manifest):
	"""Each library is the one that was built, to the byte; a damaged one would end the process, not the import."""
	for name, known in manifest['files'].items():
		try:
			with open(os.path.join(folder, name), 'rb') as file:
				data = file.read()
		except OSError as e:
			refuse('%s cannot be read (%s)' % (name, e.strerror), REBUILD)
		if len(data) != known['size']: refuse('%s has %d bytes instead of %d: it is cut short or of another build' % (name, len(data), known['size']), REBUILD)
		if zlib.crc32(data) != known['crc32']: refuse('%s is damaged (its checksum differs)' % name, REBUILD)


def checkYadeLibraries(manifest):
	"""YADE's libraries are there, whole, and those the plugin was built against; before they are loaded, if they are not yet."""
	folder = manifest['yadeLibDir']
	if 'yade.config' in sys.modules:
		config = sys.modules['yade.config']
		folder = config.libDir
		if config.version != manifest['yade']: refuse('this is YADE %s, the plugin is for %s' % (config.version, manifest['yade']), '%s; or rebuild the plugin here (pyscripts/setup)' % installYade(manifest))
		# the builds of other precision have other features but also another suffix
		if not os.path.basename(folder.rstrip('/')).endswith('-double'):
			refuse('this YADE (%s) is not the double precision build' % folder, 'start `yade` or `yade-mca`, not yade-longdouble, yade-float128 or yade-mpfr150')
	if not os.path.exists(os.path.join(folder, 'libyade.so')): refuse('YADE is not installed (no libyade.so in %s)' % folder, installYade(manifest))
	for name, known in manifest['yadeBuildIds'].items():
		path = os.path.join(folder, name)
		try:
			_elf.checkWhole(path)
			found = _elf.buildId(path)
		except (OSError, ValueError) as e:
			refuse("YADE's own library cannot be used: %s" % e, installYade(manifest, '--reinstall '))
		if found != known and not os.environ.get('YADE_MCA_OTHER_BUILD'):
			refuse(
			        "YADE's library %s is another build (%s) than the one the plugin was built with (%s)" % (path, found or 'no build-id', known),
			        '%s; or rebuild the plugin here (pyscripts/setup); or set YADE_MCA_OTHER_BUILD=1 to rely on the comparison of classes alone' % installYade(manifest, '--reinstall ')
			)


def setHome():
	"""YADE's configuration reads $HOME and fails without it, as in a job of cron or a container."""
	if os.environ.get('HOME'): return
	os.environ.pop('HOME', None)
	home = os.path.expanduser('~')  # by the list of users
	os.environ['HOME'] = home if os.path.isabs(home) else tempfile.gettempdir()


class Later(types.ModuleType):
	"""Stands for a module of which only the version was asked; the module itself is imported when anything else is."""

	def __getattr__(self, name):
		if name.startswith('__'): raise AttributeError(name)
		return getattr(importlib.import_module(self.__name__), name)


@contextlib.contextmanager
def versionOfIPython():
	"""YADE imports IPython to read its version, which takes a quarter of its start: here it finds no more than that, as long as IPython says it in the usual place."""
	name, found = 'IPython', {}
	try:
		spec = None if name in sys.modules else importlib.util.find_spec(name)
		with open(os.path.join(os.path.dirname(spec.origin), 'core', 'release.py')) as f:
			exec(compile(f.read(), f.name, 'exec'), found)
	except Exception:  # imported already, elsewhere or otherwise: YADE does as it always does
		found = {}
	if isinstance(found.get('version'), str):
		sys.modules[name] = Later(name)
		sys.modules[name].__version__ = found['version']
	try:
		yield
	finally:
		if isinstance(sys.modules.get(name), Later): del sys.modules[name]


def importYade(manifest):
	setHome()
	folder, first = os.path.join(manifest['yadeLibDir'], 'py'), 'yade' not in sys.modules
	if first and folder not in sys.path: sys.path.append(folder)
	said = io.StringIO()
	try:
		with contextlib.redirect_stdout(said), versionOfIPython():  # YADE greets each import with a line, where a task's output, or nobody, is read
			import yade.config
			import yade.system
			import yade.wrapper
	except ImportError as e:
		if sys.prefix != '/usr': refuse('YADE cannot be imported into %s (%s)' % (sys.executable, e), "use YADE's interpreter, /usr/bin/python3, or start yade or yade-mca")
		refuse('YADE cannot be imported (%s)' % e, installYade(manifest, '--reinstall '))
	rest = [line for line in said.getvalue().splitlines() if not line.startswith('Using python version')]
	if rest: print('\n'.join(rest))
	if first: atexit.register(removeTemporaryFolder, os.path.dirname(yade.wrapper.Omega().tmpFilename()), os.getpid())


def removeTemporaryFolder(folder, process):
	"""YADE makes a folder in /tmp for each process; the command `yade` removes it when it ends, an import into Python does not."""
	if os.getpid() == process: shutil.rmtree(folder, ignore_errors=True)


def openExtension(name, path, remedy='install the YADE it was built for'):
	"""Load the extension module `name` from the file `path`; its guard runs first and raises ImportError when it does not fit."""
	flags = sys.getdlopenflags()
	# YADE sets RTLD_GLOBAL for all later imports, with which weak symbols of different plugins would replace each other
	sys.setdlopenflags(os.RTLD_NOW | os.RTLD_LOCAL)
	try:
		spec = importlib.machinery.ModuleSpec(name, importlib.machinery.ExtensionFileLoader(name, str(path)), origin=str(path))
		module = importlib.util.module_from_spec(spec)
	except ImportError as e:
		if 'undefined symbol' in str(e): refuse('the YADE in this process lacks a function the plugin needs (%s)' % e, remedy)
		raise
	finally:
		sys.setdlopenflags(flags)
	sys.modules[name] = module
	return module


def insideYade():
	"""The classes where YADE was built from source with the plugin in its tree (patches/) and has loaded them itself; None with the stock package."""
	if 'yade.wrapper' not in sys.modules or '_yade_mca' in sys.modules: return None
	wrapper = sys.modules['yade.wrapper']
	if not hasattr(wrapper, 'McaInfo'): return None
	module = types.ModuleType('_yade_mca', 'built into this YADE')
	module.classes = [name for name in dir(wrapper) if 'Mca' in name]
	module.guardChecks = 0  # compiled with YADE's own headers: nothing to compare
	return module


def load():
	"""(extension module, manifest). Raises ImportError with a remedy; YADE, if it was running, goes on without the plugin."""
	builtIn = insideYade()
	if builtIn: return builtIn, {'version': 'inside YADE', 'commit': None}
	folder = libraryFolder()
	manifest = readManifest(folder)
	checkPython(manifest)
	checkFiles(folder, manifest)
	checkYadeLibraries(manifest)
	importYade(manifest)
	checkYadeLibraries(manifest)
	return openExtension('_yade_mca', os.path.join(folder, '_yade_mca.so'), installYade(manifest)), manifest


def publish(classes, package):
	"""Make the new names known where YADE's own are: here, in yade, yade.utils, and for scripts and the graphical interface in builtins."""
	import builtins
	import yade
	import yade.system
	import yade.utils
	for name in classes:
		cls = getattr(yade.wrapper, name)
		package[name] = cls
		for module in (yade, yade.utils, builtins):
			setattr(module, name, cls)
	yade.system._allSerializables |= set(classes)
	_omega.mend(yade.wrapper.Omega, yade.wrapper.McaSolverEngine)
