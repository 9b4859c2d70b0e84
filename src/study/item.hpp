/// @file item.hpp
/// What one reproduction is made of inside this layer. A new item is a function here and a row in
/// reproduce.cpp.
#pragma once
#include <filesystem>

#include "sinew/study/reproduce.hpp"

namespace sinew::inline v0 {

/// Makes the files of an item in `folder` and compares.
using StudyFunction = Expected<Reproduction> (*)(const StudyItem& item, const std::filesystem::path& folder);

Expected<Reproduction> tdpcr_fig8(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tdpcr_fig9(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tdpcr_fig10(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tdpcr_fig11(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tdpcr_fig12(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tdpcr_chains(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tripod_fig4(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tripod_fig5(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tripod_fig6(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tripod_fig7(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tripod_fig9(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tripod_fig10(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tripod_fig11(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tripod_fig12(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tripod_fig13(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tripod_equation36(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tripod_fig14(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tripod_fig15(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tripod_fig16(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tripod_table1(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tripod_table2(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> tripod_design(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> lsk_fig3(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> lsk_fig4(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> lsk_fig5(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> lsk_fig6(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> lsk_fig7(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> lsk_fig8(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> lsk_fig9(const StudyItem& item, const std::filesystem::path& folder);
Expected<Reproduction> lsk_numbers(const StudyItem& item, const std::filesystem::path& folder);

}  // namespace sinew::inline v0
