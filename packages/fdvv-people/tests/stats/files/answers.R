# Makes answers.json: random answers and what other people's programs say of them.
# R 4.2.2 with coin 1.4-2, exactRankTests 0.8-35, ordinal 2022.11-16, psyphy 0.2-3, survey 4.1-1,
# VGAM 1.1-7, jsonlite 1.8.4. Run: Rscript answers.R OUT.json 200
suppressPackageStartupMessages({
  library(coin); library(exactRankTests); library(ordinal); library(psyphy); library(survey)
  library(VGAM); library(jsonlite)
})
set.seed(20200425)
SETS <- as.integer(commandArgs(TRUE)[2])
quietly <- function(e) suppressWarnings(suppressMessages(e))
or_na <- function(e) tryCatch(quietly(e), error = function(e) NA)

signed_rank <- function(i) {
  n <- sample(4:20, 1)
  x <- switch(i %% 4 + 1,
    sample(-3:5, n, TRUE),                     # many ties and zeros
    sample(-15:20, n, TRUE),                   # some, as means of six ratings
    round(rnorm(n, 0.4), 6),                   # none
    sample(c(-1, 0, 0, 1, 2), n, TRUE))        # hardly anything else
  if (all(x == 0)) x[1] <- 1
  if (i %% 5 == 0) x[sample(n, 1)] <- NA
  y <- x[!is.na(x)]
  if (all(y == 0)) y <- x <- c(1, y)
  zero <- rep(0, length(y))
  by_coin <- function(method, how) quietly(wilcoxsign_test(y ~ zero, zero.method = method, distribution = how))
  untied <- !any(duplicated(abs(y))) && all(y != 0)
  interval <- if (untied && length(y) >= 6) quietly(stats::wilcox.test(y, conf.int = TRUE, exact = TRUE)) else NULL
  list(
    x = x,
    V = unname(quietly(stats::wilcox.test(y, exact = FALSE))$statistic),
    corrected = quietly(stats::wilcox.test(y, exact = FALSE, correct = TRUE))$p.value,
    exact = wilcox.exact(y, exact = TRUE)$p.value,
    z = as.numeric(statistic(by_coin("Wilcoxon", asymptotic()))),
    asymptotic = as.numeric(pvalue(by_coin("Wilcoxon", asymptotic()))),
    z_pratt = as.numeric(statistic(by_coin("Pratt", asymptotic()))),
    exact_coin = as.numeric(pvalue(by_coin("Wilcoxon", exact()))),
    exact_pratt = as.numeric(pvalue(by_coin("Pratt", exact()))),
    shift = if (is.null(interval)) NA else unname(interval$estimate),
    interval = if (is.null(interval)) NA else as.numeric(interval$conf.int)
  )
}

# the interval of one sample: each answer once as it is and once mirrored doubles every likelihood ratio
two_ac <- function(i) {
  counts <- as.vector(rmultinom(1, sample(8:80, 1), prob = c(runif(1, 1, 3), runif(1, 0.5, 3), runif(1, 1, 6)))) 
  counts <- pmax(counts, 1)
  d <- data.frame(r = factor(c(1:3, 3:1), ordered = TRUE), s = rep(c(1, -1), each = 3), w = rep(counts, 2))
  m <- quietly(clm(r ~ s, weights = w, data = d, link = "probit", threshold = "symmetric",
                   control = clm.control(gradTol = 1e-9)))
  bounds <- quietly(confint(m, level = pchisq(2 * qchisq(0.95, 1), 1), type = "profile"))
  list(counts = counts, d = sqrt(2) * unname(coef(m)["s"]), tau = sqrt(2) * unname(m$alpha[length(m$alpha)]),
       alpha = unname(m$alpha), interval = sqrt(2) * as.numeric(bounds))
}

d_prime <- function(i) {
  pc <- round(runif(1, 0.501, 0.995), 6)
  list(pc = pc, differencing = dprime.ABX(Pc.unb = pc, method = "diff"),
       independent = dprime.ABX(Pc.unb = pc, method = "IO"), forced = dprime.mAFC(pc, 2))
}

clustered <- function(i) {
  repeat {
    people <- sample(4:24, 1)
    n <- if (i %% 3) rep(sample(4:36, 1), people) else sample(0:30, people, TRUE)
    p <- rbeta(people, 6, 2)
    k <- rbinom(people, n, p)
    if (sum(n > 0) > 2 && sum(k) > 0 && sum(k) < sum(n)) break
  }
  d <- data.frame(person = rep(seq_along(n), n), y = unlist(mapply(function(a, b) rep(1:0, c(a, b - a)), k, n, SIMPLIFY = FALSE)))
  s <- quietly(svydesign(id = ~person, data = d, weights = ~1))
  found <- or_na(svyciprop(~y, s, method = "beta"))
  keep <- n > 0
  b <- or_na(vglm(cbind(k[keep], n[keep] - k[keep]) ~ 1, betabinomial, epsilon = 1e-9, maxit = 100))
  fit <- if (isS4(b)) as.numeric(Coef(b)) else c(NA, NA)
  list(k = k, n = n, share = as.numeric(found), interval = as.numeric(attr(found, "ci")), mu = fit[1], rho = fit[2])
}

ratings_of <- function(people, rounds, slope_sd) {
  person <- rep(seq_len(people), each = 2 * rounds)
  x <- rep(rep(0:1, each = rounds), people)
  own <- rnorm(people, 0, 0.8); steeper <- rnorm(people, 0, slope_sd)
  felt <- own[person] + (runif(1, -0.5, 1.2) + steeper[person]) * x + rnorm(length(x))
  r <- findInterval(felt, c(-1.4, -0.7, 0, 0.6, 1.3)) + 1
  data.frame(r = r, person = person, x = x)
}

ordinal_one <- function(i, slope) {
  repeat {
    d <- ratings_of(sample(6:10, 1), sample(3:4, 1), if (slope) 0.6 else 0)
    gone <- if (i %% 4 == 0) sample(nrow(d), 3) else integer(0)
    e <- if (length(gone)) d[-gone, ] else d
    e$f <- factor(e$r, ordered = TRUE); e$who <- factor(e$person)
    tight <- clmm.control(gradTol = 1e-6)
    m <- if (slope) or_na(clmm(f ~ x + (1 + x | who), data = e, link = "probit"))
         else or_na(clmm(f ~ x + (1 | who), data = e, link = "probit", nAGQ = 7, control = tight))
    if (is.list(m) && is.finite(m$logLik) && all(is.finite(or_na(vcov(m))))) break
  }
  r <- d$r; r[gone] <- 0                       # 0: missing
  sd <- sqrt(diag(VarCorr(m)$who))
  list(people = max(d$person), r = paste(r, collapse = ""), value = unname(coef(m)["x"]),
       error = summary(m)$coefficients["x", 2], thresholds = unname(m$alpha), sd = unname(sd),
       correlation = if (slope) attr(VarCorr(m)$who, "correlation")[1, 2] else NA,
       log_likelihood = as.numeric(logLik(m)))
}

two_ac_people <- function(i) {
  repeat {
    people <- sample(6:16, 1); rounds <- sample(8:36, 1)
    own <- rnorm(people, runif(1, -0.5, 1.5), 0.7); tau <- runif(1, 0.2, 0.8)
    counts <- t(sapply(own, function(d) {
      low <- pnorm((-tau - d) / sqrt(2)); high <- pnorm((d - tau) / sqrt(2))
      as.vector(rmultinom(1, rounds, c(low, 1 - low - high, high))) }))
    if (i %% 4 == 0) counts[1, ] <- c(0, 0, 1)
    if (any(colSums(counts) < 2)) next
    d <- data.frame(r = factor(rep(rep(1:3, people), as.vector(t(counts))), ordered = TRUE),
                    who = factor(rep(seq_len(people), rowSums(counts))))
    m <- or_na(clmm(r ~ 1 + (1 | who), data = d, link = "probit", nAGQ = 7, control = clmm.control(gradTol = 1e-6)))
    if (is.list(m) && is.finite(m$logLik) && all(is.finite(or_na(vcov(m))))) break
  }
  v <- vcov(m)[1:2, 1:2]
  list(counts = counts, d = -sum(m$alpha) / sqrt(2), tau = diff(unname(m$alpha)) / sqrt(2),
       error = sqrt(sum(v) / 2), sd = sqrt(2) * as.numeric(sqrt(VarCorr(m)$who[1, 1])))
}

friedman <- function(i) {
  people <- sample(4:20, 1); conditions <- sample(3:7, 1)
  scores <- matrix(sample(1:(if (i %% 2) 7 else 100), people * conditions, TRUE), people)
  f <- friedman.test(scores)
  list(scores = scores, chi2 = unname(f$statistic), p = f$p.value)
}

made <- list(
  signed_rank = lapply(seq_len(SETS), signed_rank), two_ac = lapply(seq_len(SETS), two_ac),
  d_prime = lapply(seq_len(SETS), d_prime), clustered = lapply(seq_len(SETS), clustered),
  friedman = lapply(seq_len(SETS), friedman), two_ac_people = lapply(seq_len(SETS), two_ac_people),
  ordinal = lapply(seq_len(SETS), ordinal_one, slope = FALSE),
  ordinal_slope = lapply(seq_len(SETS / 8), ordinal_one, slope = TRUE) # nine seconds each
)
lines <- sapply(names(made), function(name) {
  rows <- sapply(made[[name]], function(one) as.character(toJSON(one, digits = 10, auto_unbox = TRUE, na = "null")))
  paste0("\"", name, "\": [\n", paste(rows, collapse = ",\n"), "\n]")
})
writeLines(paste0("{\n", paste(lines, collapse = ",\n"), "\n}"), commandArgs(TRUE)[1])
