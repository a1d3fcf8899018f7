// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Part of the sanitizers' build alone. Open MPI unloads its components at the end. Memory that they
// have kept would be a leak of an unknown place then, which no list of suppressions can name:
// libraries stay loaded.

extern "C" int dlclose(void *)
{
  return 0;
}
