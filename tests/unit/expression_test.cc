// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/expression.h>
#include <perideal/scene/lists.h>

#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace SceneTests;
  using dealii::Point;


  TEST(Lists, separators_count_outside_parentheses_only)
  {
    EXPECT_EQ(split_list(" a ; b(1;2) ;c ", ';'), (std::vector<std::string>{"a", "b(1;2)", "c"}));
    EXPECT_EQ(split_list("max(x, 1), 2", ','), (std::vector<std::string>{"max(x, 1)", "2"}));
    EXPECT_EQ(split_list("0,1 ;", ';'), (std::vector<std::string>{"0,1"}));
    EXPECT_EQ(split_list("0;;1", ';'), (std::vector<std::string>{"0", "", "1"}));
    EXPECT_TRUE(split_list(" \t", ';').empty());
    EXPECT_EQ(name_and_value("top: x>0 ? 1:2", "here"),
              (std::pair<std::string, std::string>{"top", "x>0 ? 1:2"}));
  }


  TEST(Lists, numbers)
  {
    EXPECT_EQ(parse_number(" -1.5e-3 ", "w"), -1.5e-3);
    EXPECT_EQ(parse_number("+2.", "w"), 2.);
    for (const std::string text : {"12e", "abc", "", "1 2", "0x10", "inf", "nan", "1,5", "1e999"})
      expect_parts(message_of([&] { parse_number(text, "'Cells' in section 'Domain'"); }),
                   {"Entry 'Cells' in section 'Domain': "});
    EXPECT_EQ(parse_whole_number("7", "w"), 7u);
    for (const std::string text : {"-1", "1.5", "5e9"})
      expect_parts(message_of([&] { parse_whole_number(text, "w"); }), {"whole number"});
    const std::vector<Point<2>> points = parse_points<2>("0,1 ; 2, 3", "w");
    ASSERT_EQ(points.size(), 2u);
    EXPECT_EQ(points[1], Point<2>(2., 3.));
    expect_parts(message_of([] { parse_point<2>("0, 1, 2", "w"); }),
                 {"needs 2 coordinates, found 3"});
    EXPECT_EQ(number_text(0.1), "0.1");
    EXPECT_EQ(number_text(1. / 60.), "0.0166666666667");
  }


  TEST(Expressions, values)
  {
    const Point<3> p(0.5, -2., 3.);
    const auto     value = [&](const std::string &formula) {
      return Expression(formula, "w").value(p, 4.);
    };
    EXPECT_DOUBLE_EQ(value("x + 10*y + 100*z + 1000*t"), 0.5 - 20. + 300. + 4000.);
    EXPECT_DOUBLE_EQ(value("if(x > 0, 1, 2)"), 1.);
    EXPECT_DOUBLE_EQ(value("if(x > 0 && y > 0, 1, 2)"), 2.);
    EXPECT_DOUBLE_EQ(value("if(x > 0 || y > 0, 1, 2)"), 1.);
    EXPECT_DOUBLE_EQ(value("if((x > 0) | (y > 0), 1, 2)"), 1.);
    EXPECT_DOUBLE_EQ(value("if((x > 0) & (y > 0), 1, 2)"), 2.);
    EXPECT_DOUBLE_EQ(value("x >= 0.5 ? 3 : 4"), 3.);
    EXPECT_DOUBLE_EQ(value("log(E) + log10(100)"), 3.);
    EXPECT_DOUBLE_EQ(value("sin(pi/2) + cos(Pi)"), 0.);
    EXPECT_DOUBLE_EQ(value("erf(x) + erfc(x)"), 1.);
    EXPECT_DOUBLE_EQ(value("sec(x)*cos(x) + csc(x)*sin(x) + cot(x)*tan(x)"), 3.);
    EXPECT_DOUBLE_EQ(value("floor(-1.5) + ceil(1.2) + int(2.7) + rint(0.8)"), 3.);
    EXPECT_DOUBLE_EQ(value("pow(2, 3) + min(1, 2) + max(1, 2) + atan2(0, 1)"), 11.);
    EXPECT_DOUBLE_EQ(value("-2^2 + 2^3^2"), 508.);
    // coordinates beyond the dimension are zero
    EXPECT_DOUBLE_EQ(Expression("1 + y + z", "w").value(Point<1>(7.)), 1.);
    EXPECT_DOUBLE_EQ(Expression(2.5).value(p), 2.5);
    EXPECT_EQ(Expression().value(p), 0.);
  }


  TEST(Expressions, what_they_depend_on)
  {
    EXPECT_TRUE(Expression("2*pi", "w").is_constant());
    EXPECT_FALSE(Expression("t", "w").is_constant());
    EXPECT_TRUE(Expression("t", "w").depends_on_time());
    EXPECT_FALSE(Expression("t", "w").depends_on_position());
    EXPECT_TRUE(Expression("exp(z)", "w").depends_on_position());
    EXPECT_FALSE(Expression("exp(z)", "w").depends_on_time());
    EXPECT_EQ(Expression(" 1 + x ", "w").text(), "1 + x");
    const Expression original("x", "w"), copy = original;
    EXPECT_EQ(copy.value(Point<1>(3.)), 3.);
    // several thousand characters
    std::string sum = "x";
    for (unsigned int i = 0; i < 2000; ++i)
      sum += "+1*x";
    EXPECT_DOUBLE_EQ(Expression(sum, "w").value(Point<1>(1.)), 2001.);
  }


  TEST(Expressions, errors)
  {
    const auto check = [](const std::string &formula, const std::vector<std::string> &parts) {
      const std::string message =
        message_of([&] { Expression(formula, "'Source' in section 'Initial and source'"); });
      expect_parts(message, {"'Source' in section 'Initial and source'", formula});
      expect_parts(message, parts);
    };
    check("2*xx", {"column 3", "unknown name 'xx'"});
    check("1 + sqr(x)", {"column 5", "unknown name 'sqr'; did you mean 'sqrt'?"});
    check("2*T",
          {"column 3",
           "'T': the temperature is available in formulas of the material only",
           "x, y, z, t"});
    check("sin(", {"ends too early"});
    check("(1+2", {"closing parenthesis is missing"});
    check("1+2)", {"column 4", "unexpected parenthesis ')'"});
    check("2x", {"column 2", "an operator is missing before 'x'"});
    check("x y", {"column 3", "an operator is missing before 'y'"});
    check("sin x", {"column 1", "'sin' needs its arguments in parentheses"});
    check("x**2", {"column 3", "unexpected operator '*'", "x^2"});
    check("sin(1,2)", {"'sin' has too many arguments"});
    check("if(x>0,1)", {"'if' has too few arguments"});
    check("12e", {"column 1", "'12e' is not a number"});
    check("x = 3", {"column 3", "write '=='"});
    check("if(x=3,1,2)", {"column 5", "write '=='"});
    check("3, 4", {"gives 2 values, needs one"});
    check("3*(x+,2)", {"column 6", "unexpected comma"});
    check("x $ 3", {"column 3", "unexpected character '$'"});
    check("rand()", {"column 1", "random numbers"});
    check("x > 1 and y > 1", {"column 7", "write &&"});
    check("1/0", {"not finite"});
    check("x > 0 ? 1", {"'?' without ':'"});
    check("", {"is empty"});
    std::string sum = "1";
    for (unsigned int i = 0; i < 1000; ++i)
      sum += "+1";
    const std::string message = message_of([&] { Expression(sum + "+foo", "'Source'"); });
    expect_parts(message, {"'...", "+1+foo'", "column 2003", "unknown name 'foo'"});
    EXPECT_LT(message.size(), 250u);
    for (unsigned int i = 0; i < 20000; ++i)
      sum += "+1";
    expect_parts(message_of([&] { Expression(sum, "'Source'"); }), {"longer than muparser allows"});
    EXPECT_EQ(message_of([] { Expression("x <= 1 && x >= 0 && x != 2 && x == 1", "w"); }), "");
    expect_parts(message_of([] { Expression("1/x", "'Source'").value(Point<2>(0., 0.5), 2.); }),
                 {"'Source'", "'1/x' is not finite at (0, 0.5), t = 2"});
  }
} // namespace PeriDeal
