// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Which bonds are whole, and since when not.

#include <perideal/bonds/bond_state.h>

#include <gtest/gtest.h>

using namespace PeriDeal;


TEST(BondState, without_a_list_all_are_whole)
{
  const BondState state;
  EXPECT_EQ(state.size(), 0u);
  EXPECT_TRUE(state.is_whole(7));
  EXPECT_EQ(state[7], BondState::whole);
  EXPECT_EQ(state.since(7), std::numeric_limits<double>::infinity());
}


TEST(BondState, keeps_why_and_since_when)
{
  BondState state;
  state.resize(10);
  state.mark(3, BondState::parted, 0.);
  state.mark(8, BondState::broken, 0.25);
  state.mark(1, BondState::dependent, 0.5);
  for (const std::size_t k : {0u, 2u, 4u, 5u, 6u, 7u, 9u})
    {
      EXPECT_TRUE(state.is_whole(k));
      EXPECT_EQ(state.since(k), std::numeric_limits<double>::infinity());
    }
  EXPECT_FALSE(state.is_whole(3));
  EXPECT_EQ(state[3], BondState::parted);
  EXPECT_EQ(state[8], BondState::broken);
  EXPECT_EQ(state[1], BondState::dependent);
  EXPECT_EQ(state.since(3), 0.);
  EXPECT_EQ(state.since(8), 0.25);
  EXPECT_EQ(state.since(1), 0.5);
  EXPECT_EQ(state.count(BondState::whole), 7u);
  EXPECT_EQ(state.count(BondState::broken), 1u);
  EXPECT_GE(state.memory_consumption(), 3u);
  EXPECT_LT(state.memory_consumption(), 200u);
}


TEST(BondState, keeps_marks_while_its_list_grows)
{
  BondState   state;
  std::size_t n_known = 0;
  const auto  mark_of = [](const std::size_t k) {
    return k % 5 == 0 ? BondState::broken : k % 5 == 3 ? BondState::dependent : BondState::whole;
  };
  for (std::size_t n = 0; n < 203; n += 7)
    {
      state.resize(n + 7);
      EXPECT_EQ(state.size(), n + 7);
      for (std::size_t k = n; k < n + 7; ++k)
        if (mark_of(k) != BondState::whole)
          state.mark(k, mark_of(k), static_cast<double>(n / 21));
      for (const auto &[number, time] : state.marked_since(n_known))
        {
          EXPECT_GE(number, n);
          EXPECT_EQ(time, static_cast<double>(n / 21));
        }
      EXPECT_EQ(n_known, state.n_marks());
    }
  EXPECT_TRUE(state.is_whole(203));
  for (std::size_t k = 0; k < state.size(); ++k)
    {
      EXPECT_EQ(state[k], mark_of(k));
      if (!state.is_whole(k))
        EXPECT_EQ(state.since(k), static_cast<double>(k / 7 * 7 / 21));
    }
  EXPECT_EQ(state.count(BondState::whole) + state.n_marks(), state.size());
  // Two bits a bond and a number for each mark, and at most an eighth of that beside.
  EXPECT_LT(state.memory_consumption(), 1.2 * (203 / 4. + 8. * state.n_marks()) + 16. * 16.);
}
