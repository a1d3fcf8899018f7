# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 the PeriDeal authors
"""Runs that become unstable on their way: each is stopped soon after it begins to, says where and why, and keeps what it had.

Arguments: parts. `stopped`: each run, on one process and on two. `actions`: warn, off. `share`: the time that guards take, printed.
"""

import glob
import math
import os
import sys
import xml.etree.ElementTree as xml

import h5py
import numpy

from scene_test import check, check_clean_error, check_less, finish, print_table, run_scene

SOON = 20  # steps after the first growth

PLATE = """
set Models = peridynamics
subsection Domain
  set Cells = 20, 20
end
subsection Boundary conditions
  set Dirichlet = left: 0; right: 0
end
"""

# The source has no value after t = 0.05.
SOURCE_ENDS = PLATE + """
subsection Initial and source
  set Source = 10*sqrt(0.05 - t)
end
subsection Time
  set End time = 0.2
  set Stepper  = euler
end
subsection Output
  set Write every = 0.02
end
"""

# A step of forward Euler that is stable at the start.
WARMING = PLATE + """
subsection Material
  set Conductivity = 1 + 10*T
end
subsection Initial and source
  set Source = 10
end
subsection Time
  set End time  = 2
  set Stepper   = euler
  set Time step = 4e-4
end
subsection Output
  set Write every = 0.004
end
"""

# A given value that becomes infinite at t = 0.05.
VALUE_EXPLODES = """
set Dimension = 1
set Models    = finite elements
subsection Domain
  set Lower corner = 0
  set Upper corner = 1
  set Cells        = 40
end
subsection Boundary conditions
  set Dirichlet = left: 1/(0.05 - t); right: 0
end
subsection Time
  set End time = 0.2
end
subsection Output
  set Write every = 0.02
end
"""

BODY = """
set Physics = elasticity
set Models  = peridynamics
subsection Material
  set Young modulus = 100
  set Poisson ratio = 0.3
  set Density       = 1.0
"""

# Half of a strip flies away from the half that is held.
FLYING = BODY + """
  set Fracture energy = 0.001
end
subsection Domain
  set Upper corner = 2, 0.5
  set Cells        = 32, 8
end
subsection Initial and source
  set Initial velocity = if(x > 1, 2, 0), 0
end
subsection Boundary conditions
  set Displacement = left: 0, 0
end
subsection Elasticity
  set Solver     = dynamics
  set Kinematics = linear
end
subsection Time
  set End time = 3
end
subsection Output
  set Write every = 0.2
end
"""

# A strip is pulled until a step that was stable at the start is not any more.
PULLED = BODY + """
end
subsection Domain
  set Upper corner = 1, 0.25
  set Cells        = 16, 4
end
subsection Boundary conditions
  set Displacement = left: 0, 0; right: 2.5*(t/4)^2, 0
end
subsection Elasticity
  set Solver     = dynamics
  set Kinematics = full
end
subsection Time
  set End time  = 4
  set Stepper   = verlet
  set Time step = STEP
end
subsection Output
  set Write every = 0.25
end
"""
