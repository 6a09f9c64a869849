//! The pages of lists: the part of a list that a request asks for.
//!
//! A list is asked for whole, or page by page: `limit` says how many entries, and `after` which was the last one of the page before. A page
//! with fewer entries than its limit is the last one. Without `limit` all are answered, as before there were pages.

use std::collections::BTreeMap;

use serde::Deserialize;
use shared::api::ErrorKind;
use store::IdPage;

use super::error::HttpError;

/// The largest number of entries of a page.
const MAX_LIMIT: u32 = 10_000;

/// The page of a list that is ordered by numbers, and whether archived studies count.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StudiesPage {
    #[serde(default)]
    pub(super) archived: bool,
    limit: Option<u32>,
    after: Option<i64>,
}

/// The page of a list that is ordered by numbers.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct NumbersPage {
    limit: Option<u32>,
    after: Option<i64>,
}

/// The page of a list whose entries have names.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct NamesPage {
    limit: Option<u32>,
    after: Option<String>,
}

impl StudiesPage {
    /// Returns the page.
    ///
    /// # Errors
    /// A limit out of bounds.
    pub(super) fn page(&self) -> Result<IdPage, HttpError> {
        page(self.limit, self.after)
    }
}

impl NumbersPage {
    /// Returns the page.
    ///
    /// # Errors
    /// A limit out of bounds.
    pub(super) fn page(&self) -> Result<IdPage, HttpError> {
        page(self.limit, self.after)
    }
}

impl NamesPage {
    /// Cuts the page out of a list.
    ///
    /// # Errors
    /// A limit out of bounds, or a name that is not in the list.
    pub(super) fn cut<T>(self, entries: Vec<T>, name: impl Fn(&T) -> &str) -> Result<Vec<T>, HttpError> {
        let limit = limit(self.limit)?;
        let skipped = match self.after {
            None => 0,
            Some(after) => {
                let place = entries.iter().position(|entry| name(entry) == after);
                let unknown = || format!("after = {after:?} is not in the list");
                1 + place.ok_or_else(|| HttpError::new(ErrorKind::InvalidBody, unknown()))?
            }
        };
        let limit = limit.map_or(usize::MAX, |limit| limit as usize);
        Ok(entries.into_iter().skip(skipped).take(limit).collect())
    }
}

impl NamesPage {
    /// Cuts the page out of a list that is ordered by its names, from which entries may have gone since the page before.
    ///
    /// # Errors
    /// A limit out of bounds.
    pub(super) fn cut_sorted<T>(
        self,
        mut entries: BTreeMap<String, T>,
    ) -> Result<BTreeMap<String, T>, HttpError> {
        let limit = limit(self.limit)?.map_or(usize::MAX, |limit| limit as usize);
        if let Some(after) = self.after {
            entries = entries.split_off(&after);
            entries.remove(&after);
        }
        Ok(entries.into_iter().take(limit).collect())
    }
}

fn page(asked: Option<u32>, after: Option<i64>) -> Result<IdPage, HttpError> {
    Ok(IdPage {
        after: after.unwrap_or(IdPage::ALL.after),
        limit: limit(asked)?.map_or(IdPage::ALL.limit, i64::from),
    })
}

fn limit(asked: Option<u32>) -> Result<Option<u32>, HttpError> {
    match asked {
        Some(limit) if !(1..=MAX_LIMIT).contains(&limit) => Err(HttpError::new(
            ErrorKind::InvalidBody,
            format!("limit = {limit} must lie in 1 to {MAX_LIMIT}"),
        )),
        asked => Ok(asked),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_of_names_begins_behind_the_one_that_it_names_and_limits_have_bounds() {
        let cut = |limit, after: Option<&str>| {
            let page = NamesPage {
                limit,
                after: after.map(str::to_owned),
            };
            page.cut(vec!["z", "a", "m"], |name| name)
        };
        assert_eq!(cut(None, None).unwrap(), ["z", "a", "m"]);
        assert_eq!(cut(Some(2), None).unwrap(), ["z", "a"]);
        assert_eq!(cut(Some(2), Some("a")).unwrap(), ["m"]);
        assert!(cut(Some(2), Some("m")).unwrap().is_empty());
        let refused = |limit, after| cut(limit, after).unwrap_err().to_string();
        assert_eq!(refused(None, Some("q")), "after = \"q\" is not in the list");
        assert_eq!(refused(Some(0), None), "limit = 0 must lie in 1 to 10000");
        assert_eq!(
            refused(Some(10_001), None),
            "limit = 10001 must lie in 1 to 10000"
        );
        assert_eq!(page(None, None).unwrap(), IdPage::ALL);
        let sorted = |after: Option<&str>| {
            let page = NamesPage {
                limit: Some(1),
                after: after.map(str::to_owned),
            };
            let page = page.cut_sorted(["a", "m", "z"].map(|name| (name.to_owned(), ())).into());
            page.unwrap().into_keys().collect::<Vec<_>>()
        };
        assert_eq!(
            [None, Some("a"), Some("b"), Some("z")].map(sorted).concat(),
            ["a", "m", "m"]
        );
    }
}
