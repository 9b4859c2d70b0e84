/// @file item.hpp
/// What one reproduction is made of inside this layer. A new item is a function here and a row in
/// reproduce.cpp.
#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "io/figure/figure.hpp"
#include "sinew/io/table.hpp"
#include "study/reproduce.hpp"

namespace sinew::inline v1 {

Expected<ItemResult> tdpcr_fig8(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tdpcr_fig9(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tdpcr_fig10(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tdpcr_fig11(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tdpcr_fig12(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tdpcr_chains(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tripod_fig4(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tripod_fig5(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tripod_fig6(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tripod_fig7(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tripod_fig9(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tripod_fig10(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tripod_fig11(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tripod_fig12(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tripod_fig13(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tripod_equation36(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tripod_fig14(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tripod_fig15(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tripod_fig16(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tripod_table1(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tripod_table2(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> tripod_design(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> lsk_fig3(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> lsk_fig4(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> lsk_fig5(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> lsk_fig6(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> lsk_fig7(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> lsk_fig8(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> lsk_fig9(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> lsk_numbers(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> truth_tables(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> truth_rods(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> truth_arms(const StudyItem& item, const std::filesystem::path& folder);
Expected<ItemResult> truth_models(const StudyItem& item, const std::filesystem::path& folder);

}  // namespace sinew::inline v1
