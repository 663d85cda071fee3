# SPDX-License-Identifier: GPL-2.0-or-later
"""Exact solutions and references that the verification compares with. Plain numbers and numpy arrays in SI units; no YADE needed.

shock        shock adiabat, impedance match, elastic limit, elastic-plastic piston
waves        Rayleigh speed, Lamb's problem on the surface of a half-plane
lattice      phase speeds of the hexagonal packing (Bloch analysis), reflection at a tied row
space_lattice  phase speeds and largest stable step of the face-centred cubic packing (Bloch analysis)
penetrator   Alekseevskii-Tate rod, penetration of a plate
shell        collapse of a plastic cylindrical shell
beam         bending frequency of a free beam
hole         a round hole in an elastic plane under tension
"""
from .beam import freeBeam
from .hole import kirsch
from .lattice import chainReflection, hexagonalSpeeds, hexagonalStableStep, tiedLatticeReflection, tiedRowReflection
from .penetrator import Tate, tatePlate
from .shell import shellStopRadius, shellVelocity
from .shock import Hugoniot, elasticLimit, impedanceMatch, piston
from .space_lattice import fccModes, fccSpeeds, fccStableStep
from .waves import lambSurface, rayleighSpeed, ricker

__all__ = [
        'Hugoniot', 'Tate', 'chainReflection', 'elasticLimit', 'fccModes', 'fccSpeeds', 'fccStableStep', 'freeBeam', 'hexagonalSpeeds', 'hexagonalStableStep', 'impedanceMatch', 'kirsch', 'lambSurface', 'piston',
        'rayleighSpeed', 'ricker', 'shellStopRadius', 'shellVelocity', 'tatePlate', 'tiedLatticeReflection', 'tiedRowReflection'
]
