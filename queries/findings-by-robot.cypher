// name: findings-by-robot
// kind: count
// description: How many findings begin or end at each robot, by kind of data?
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns robot: string, name of the robot; infrastructure and what else is shared have rows of their own
// returns verdict: string, of the whole robot; a DDS domain has none
// returns category: string, the kind of data that arrives
// returns findings: integer, how many pairs of source and leak, without the dismissed ones
// returns pseudonymised: integer, how many of these it reaches in pseudonymised form only
// returns dismissed: integer, how many more lie behind another leak of the category only
// returns ending: integer, how many of the findings end here and begin at another robot
// order: robot, category
MATCH (f:Finding)
WHERE $robot = '' OR f.robot = $robot OR f.leak_robot = $robot
UNWIND CASE f.robot WHEN f.leak_robot THEN [f.robot] ELSE [f.robot, f.leak_robot] END AS robot
WITH robot, f WHERE $robot = '' OR robot = $robot
WITH robot, f.category AS category, count(CASE WHEN f.dismissed THEN null ELSE f END) AS findings,
     count(CASE WHEN f.pseudonymised AND NOT f.dismissed THEN f END) AS pseudonymised,
     count(CASE WHEN f.dismissed THEN f END) AS dismissed,
     count(CASE WHEN f.robot <> robot AND NOT f.dismissed THEN f END) AS ending
OPTIONAL MATCH (r:Robot {name: robot})
RETURN robot, r.verdict AS verdict, category, findings, pseudonymised, dismissed, ending
ORDER BY robot, category
