// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/parameter_acceptor.h>

#include <perideal/scene/physics.h>

#include <functional>
#include <string>
#include <type_traits>
#include <vector>

namespace PeriDeal
{
  /**
   * What the text of an entry is made of; the manual prints it and the scan of a scene checks it.
   */
  enum class EntryType
  {
    text,
    number,
    whole_number,
    boolean,
    choice,
    choices, // several of the choices, separated by commas
    formula,
    list
  };


  /** One entry of a section: all that the manual says about it, and its text at present. */
  struct Entry
  {
    std::string              name;
    EntryType                type = EntryType::text;
    std::string              default_text;
    std::string              unit; // "1" for pure numbers, empty where a unit makes no sense
    std::string              documentation;
    std::vector<std::string> choices;
    std::string              text;
  };


  /** What a number has to be; messages say "found 0, needs <needs>." */
  struct Bounds
  {
    double      least, most;
    bool        with_ends; // which may be taken
    const char *needs;

    bool hold(const double value) const
    {
      return with_ends ? value >= least && value <= most : value > least && value < most;
    }

    /** The same in other words. */
    Bounds saying(const char *words) const
    {
      return {least, most, with_ends, words};
    }

    static const Bounds none, positive, fraction, not_negative, one_or_more, one_to_three, length;
  };


  /**
   * One section of a scene file. A section keeps the texts of its entries and turns them into
   * values in parse(), where all mistakes become UserErrors that name the entry. An entry is
   * declared with the member that has its value; what joins several entries, or is no plain value,
   * is added by the parse() of the section itself.
   *
   * Entries are declared and read through the virtual functions of ParameterAcceptor rather than by
   * add_parameter(): that one would leave pointers to members in the global ParameterAcceptor::prm,
   * which dangle once a scene is gone. So sections can come and go any number of times, and prm
   * needs no clearing.
   */
  class SceneSection : public dealii::ParameterAcceptor
  {
  public:
    /** @param name the section as users write it; empty: the entries stand outside all sections. */
    explicit SceneSection(const std::string &name);

    SceneSection(const SceneSection &) = delete;

    /**
     * Takes over the texts of another section of the same name; values are members' own, and
     * entries stay bound to those of this section.
     */
    SceneSection &operator=(const SceneSection &other)
    {
      list = other.list;
      return *this;
    }

    void declare_parameters(dealii::ParameterHandler &prm) override;

    void parse_parameters(dealii::ParameterHandler &prm) override;

    /** The texts of the entries that are declared with a member into these. Throws UserError. */
    void parse();

    /** The name of the section as users write it; empty outside all sections. */
    const std::string &name() const
    {
      return section;
    }

    const std::vector<Entry> &entries() const
    {
      return list;
    }

    const std::string &text(const std::string &entry) const;

    /** Whether the text of an entry differs from its default. */
    bool is_given(const std::string &entry) const;

    /**
     * Give an entry its text, as a scene file would; call parse() of the section (or of the scene)
     * afterwards.
     */
    void set(const std::string &entry, const std::string &text);

    /** "'Cells' in section 'Domain'": how messages name an entry. */
    std::string where(const std::string &entry) const;

    /** If there is a fault, throw the UserError "Entry '..' in section '..': <what>". */
    void refuse(const bool fault, const std::string &entry, const std::string &what) const;

  protected:
    using Choices = std::vector<std::string>;

    /*
     * Declare an entry, in constructors: what is returned is its documentation, to be assigned.
     * With a member it gets the value of the default, and that of the text in parse().
     */

    /** One whose text the section itself reads. */
    std::string &declare(const std::string &name,
                         const EntryType    type,
                         const std::string &default_text = "",
                         const std::string &unit         = "",
                         const Choices     &choices      = {});

    std::string &declare(double            &member,
                         const std::string &name,
                         const std::string &default_text,
                         const std::string &unit,
                         const Bounds      &bounds = Bounds::none);

    /** A number that may be left out, by the text of the default: -1 then. */
    std::string &declare_if_given(double            &member,
                                  const std::string &name,
                                  const std::string &default_text,
                                  const std::string &unit,
                                  const Bounds      &bounds);

    /** A count. */
    std::string &declare(unsigned int      &member,
                         const std::string &name,
                         const std::string &default_text,
                         const Bounds      &bounds = Bounds::none);

    std::string &declare(bool &member, const std::string &name, const std::string &default_text);

    /** A text, one of the choices if there are any. */
    std::string &declare(std::string       &member,
                         const std::string &name,
                         const std::string &default_text,
                         const Choices     &choices = {},
                         const std::string &unit    = "");

    /** One of the choices: the enumeration lists its values in the same order. */
    template <typename Enum, typename = std::enable_if_t<std::is_enum_v<Enum>>>
    std::string &declare(Enum              &member,
                         const std::string &name,
                         const std::string &default_text,
                         const Choices     &choices)
    {
      return bind(
        {name, EntryType::choice, default_text, "", "", choices, ""},
        [this, &member](const Entry &entry) { member = static_cast<Enum>(choice_index(entry)); });
    }

    /**
     * Positions of the names of a list among the entry's choices; an empty list or a name twice is
     * an error.
     */
    std::vector<unsigned int> choice_indices(const std::string &entry) const;

    /** An entry that is given, but with another physics. */
    void refuse_unless_elastic(const std::string &entry,
                               const Physics      physics,
                               const std::string &remedy = "") const;

    /** Throw the UserError "Entry '..' in section '..': <what>". */
    [[noreturn]] void error(const std::string &entry, const std::string &what) const;

  private:
    using Reader = std::function<void(const Entry &)>;

    /** The documentation of the entry, whose text @p read turns into a member of this section. */
    std::string &bind(const Entry &entry, const Reader &read);

    unsigned int choice_index(const Entry &entry) const;

    const Entry &find(const std::string &entry) const;

    std::string         section;
    std::vector<Entry>  list;
    std::vector<Reader> readers; // of each entry
  };


  /**
   * Throw a UserError unless @p text is a plain value of the type of @p entry: number, whole
   * number, boolean or choice.
   */
  void check_plain_value(const Entry &entry, const std::string &text, const std::string &where);

  /** "in section 'Domain'", or "outside all sections" without a name. */
  std::string in_section(const std::string &section);

  /** "number", "one of: box, plate with hole": what the manual says on the type of an entry. */
  std::string type_text(const Entry &entry);
} // namespace PeriDeal
