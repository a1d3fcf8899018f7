// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/parameter_acceptor.h>

#include <string>
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


  /**
   * One section of a scene file. A section keeps the texts of its entries and turns them into
   * values in its parse(), where all mistakes become UserErrors that name the entry.
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

    /** Takes over the texts of another section of the same name; values are members' own. */
    SceneSection &operator=(const SceneSection &other)
    {
      list = other.list;
      return *this;
    }

    void declare_parameters(dealii::ParameterHandler &prm) override;

    void parse_parameters(dealii::ParameterHandler &prm) override;

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
    /** Declare an entry. Called in constructors. */
    void declare(const std::string              &name,
                 const EntryType                 type,
                 const std::string              &default_text,
                 const std::string              &unit,
                 const std::string              &documentation,
                 const std::vector<std::string> &choices = {});

    /** Whether the text of an entry differs from its default. */
    bool is_given(const std::string &entry) const;

    double number(const std::string &entry) const;

    /** A number > 0. */
    double positive_number(const std::string &entry) const;

    unsigned int whole_number(const std::string &entry) const;

    bool boolean(const std::string &entry) const;

    /**
     * Position of the text among the entry's choices; enums list their values in the same order.
     */
    template <typename Enum>
    Enum choice(const std::string &entry) const
    {
      return static_cast<Enum>(choice_index(entry));
    }

    /** The text of a choice, checked. */
    const std::string &choice_name(const std::string &entry) const;

    /** A number between 0 and 1, both excluded. */
    double fraction(const std::string &entry) const;

    /**
     * Positions of the names of a list among the entry's choices; an empty list or a name twice is
     * an error.
     */
    std::vector<unsigned int> choice_indices(const std::string &entry) const;

    /** Throw the UserError "Entry '..' in section '..': <what>". */
    [[noreturn]] void error(const std::string &entry, const std::string &what) const;

  private:
    unsigned int choice_index(const std::string &entry) const;

    const Entry &find(const std::string &entry) const;

    std::string        section;
    std::vector<Entry> list;
  };


  /**
   * Throw a UserError unless @p text is a plain value of the type of @p entry: number, whole
   * number, boolean or choice.
   */
  void check_plain_value(const Entry &entry, const std::string &text, const std::string &where);

  /** "number", "one of: box, plate with hole": what the manual says on the type of an entry. */
  std::string type_text(const Entry &entry);
} // namespace PeriDeal
