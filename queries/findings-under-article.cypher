// name: findings-under-article
// kind: table
// description: To which findings, not counting dismissed ones, can an article of the GDPR apply, and why?
// param article: string, number of the article, such as 9, 9(1) or 10, default "9"
// param may: boolean, also data that only may reveal what the article speaks of, default true
// param robot: robot, only this robot; all of them if it is empty, default ""
// returns provision: string, short name of the provision
// returns verdict: string, whether the data falls under it: always, conditional or may-reveal
// returns condition: string, when; absent where it always does
// returns stated_of: string, the category, or the broader or narrower ones, that the ontology says it of
// returns robot: string, name of the robot
// returns category: string, the kind of data that arrives
// returns source: string, where the data comes in
// returns special_from: string, where other data is made into such data on the way; absent if nowhere
// returns leak: string, where it gets out
// returns pseudonymised: boolean, whether it arrives in pseudonymised form only
// order: provision, robot, category, source, leak, verdict
WITH 'GDPR Art. ' + $article AS start
MATCH (p:LegalProvision)<-[u:FALLS_UNDER]-(c:DataCategory)
WHERE (p.name = start OR p.name STARTS WITH start + ' ' OR p.name STARTS WITH start + '(')
  AND ($may OR u.verdict <> 'may-reveal')
MATCH (c)<-[:OF_CATEGORY]-(f:Finding {dismissed: false})
WHERE $robot = '' OR f.robot = $robot
RETURN p.name AS provision, u.verdict AS verdict, u.condition AS condition, u.stated_of AS stated_of, f.robot AS robot,
       f.category AS category, f.source AS source, f.special_from AS special_from, f.leak AS leak,
       f.pseudonymised AS pseudonymised
ORDER BY provision, robot, category, source, leak, verdict
