// name: changes
// kind: table
// description: Which findings came, went or stand otherwise since a day, on robots that were loaded before?
// param since: string, only loads from this time on, such as 2026-11-23 or 2026-11-23T08:00:00Z; all of them if it is empty, default ""
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns at: string, when the load began that brought the change, in UTC
// returns robot: string, name of the robot where the finding begins
// returns what: string, new, gone, or changed: dismissed or pseudonymised as it was not before
// returns kind: string, disclosure, storage-limitation, third-country-transfer or unprotected-channel
// returns category: string, the kind of data that arrives
// returns source: string, where it begins
// returns leak: string, where it gets to
// returns dismissed: boolean, whether every path goes through another leak; of what is gone, as it was
// returns pseudonymised: boolean, whether it arrives in pseudonymised form only; of what is gone, as it was
// order: at, robot, category, source, leak, kind
MATCH (c:Change)
WHERE c.at >= $since AND ($robot = '' OR c.robot = $robot)
RETURN c.at AS at, c.robot AS robot, c.what AS what, c.kind AS kind, c.category AS category, c.source AS source,
       c.leak AS leak, c.dismissed AS dismissed, c.pseudonymised AS pseudonymised
ORDER BY at, robot, category, source, leak, kind
