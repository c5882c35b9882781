// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

// What this folder uses of PCL's filters, search, segmentation and sample consensus, compiled for
// its point types. Only libpcl_common is linked: Debian's other libraries of PCL need each other,
// 86 MB for what is less than 1 MB here.

#include <pcl/point_types.h>
#include <pcl/filters/impl/filter.hpp>
#include <pcl/filters/impl/filter_indices.hpp>
#include <pcl/filters/impl/passthrough.hpp>
#include <pcl/filters/impl/radius_outlier_removal.hpp>
#include <pcl/filters/impl/voxel_grid.hpp>
#include <pcl/kdtree/impl/kdtree_flann.hpp>
#include <pcl/sample_consensus/impl/ransac.hpp>
#include <pcl/sample_consensus/impl/sac_model_plane.hpp>
#include <pcl/search/impl/kdtree.hpp>
#include <pcl/search/impl/organized.hpp>
#include <pcl/search/impl/search.hpp>
#include <pcl/segmentation/impl/region_growing.hpp>
#include <pcl/segmentation/impl/region_growing_rgb.hpp>

template class pcl::Filter<pcl::PointXYZRGB>;
template class pcl::FilterIndices<pcl::PointXYZRGB>;
template class pcl::PassThrough<pcl::PointXYZRGB>;
template class pcl::VoxelGrid<pcl::PointXYZRGB>;
template class pcl::RadiusOutlierRemoval<pcl::PointXYZRGB>;
template class pcl::KdTreeFLANN<pcl::PointXYZRGB>;
template class pcl::search::Search<pcl::PointXYZRGB>;
template class pcl::search::KdTree<pcl::PointXYZRGB>;
template class pcl::search::OrganizedNeighbor<pcl::PointXYZRGB>;
template class pcl::RegionGrowing<pcl::PointXYZRGB, pcl::Normal>;
template class pcl::RegionGrowingRGB<pcl::PointXYZRGB>;
template class pcl::SampleConsensusModelPlane<pcl::PointXYZ>;
template class pcl::RandomSampleConsensus<pcl::PointXYZ>;
