// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/problem_factory.h>

#include <string>

namespace PeriDeal
{
  /**
   * Build the first model of a scene and answer a question about it that no run answers: what its
   * steps do, what its coupling is worth, how hard it is to solve. doc/python.md lists them.
   *
   * @param question an object of JSON, with its kind as "ask"
   * @return the answer, an object of JSON, on all processes
   *
   * Throws UserError for mistakes of the scene and of the question. Collective.
   */
  std::string answer_about_model(const SceneText &text, const std::string &question);
} // namespace PeriDeal
